#include <lagroid/run/files/hdf5_file.hpp>
#include <lagroid/run/files/output_folder.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace lagroid {

void set_attribute(const H5::H5Object& object, const std::string& name, const std::string& value) {
  const H5::StrType type(H5::PredType::C_S1, std::max<std::size_t>(1, value.size()));
  object.createAttribute(name, type, H5::DataSpace(H5S_SCALAR)).write(type, value.c_str());
}

std::string components_attribute(std::size_t part) {
  return part == 0 ? std::string("components") : fmt::format("components {}", part + 1);
}

namespace {

H5::DSetCreatPropList timeless() {
  H5::DSetCreatPropList out;
  H5Pset_obj_track_times(out.getId(), false);
  return out;
}

/// A name in which no group is seen.
std::string label_of(std::string name) {
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

}  // namespace

H5::DataSet add_dataset(const H5::Group& group, const std::string& name, const std::vector<double>& values,
                        std::size_t width) {
  const hsize_t dimensions[2] = {width > 0 ? values.size() / width : 0, width};
  const H5::DataSpace space(width == 1 ? 1 : 2, dimensions);
  H5::DataSet set = group.createDataSet(label_of(name), H5::PredType::NATIVE_DOUBLE, space, timeless());
  if (!values.empty()) set.write(values.data(), H5::PredType::NATIVE_DOUBLE);
  return set;
}

H5::DataSet add_texts(const H5::Group& group, const std::string& name, const std::vector<std::string>& texts) {
  std::size_t longest = 1;
  for (const std::string& text : texts) longest = std::max(longest, text.size());
  std::string bytes(texts.size() * longest, '\0');
  for (std::size_t i = 0; i < texts.size(); ++i) texts[i].copy(&bytes[i * longest], longest);
  const H5::StrType type(H5::PredType::C_S1, longest);
  const hsize_t size = texts.size();
  H5::DataSet set = group.createDataSet(label_of(name), type, H5::DataSpace(1, &size), timeless());
  if (!texts.empty()) set.write(bytes.data(), type);
  return set;
}

void write_hdf5(const std::filesystem::path& file, const std::function<void(const H5::H5File&)>& fill) {
  H5::Exception::dontPrint();
  std::string image;
  try {
    H5::FileAccPropList in_memory;
    in_memory.setCore(/*increment=*/1 << 20, /*backing_store=*/false);
    H5::H5File out(file.string(), H5F_ACC_TRUNC, H5::FileCreatPropList::DEFAULT, in_memory);
    fill(out);
    out.flush(H5F_SCOPE_GLOBAL);
    const auto size = H5Fget_file_image(out.getId(), nullptr, 0);
    if (size < 0) throw H5::FileIException("H5Fget_file_image", "no image of the file");
    image.resize(std::size_t(size));
    if (H5Fget_file_image(out.getId(), image.data(), image.size()) != size)
      throw H5::FileIException("H5Fget_file_image", "no image of the file");
  } catch (const H5::Exception& error) {
    throw OutputError(fmt::format("{}: HDF5: {}", file.string(), error.getDetailMsg()));
  }
  write_text(image, file);
}

}  // namespace lagroid
