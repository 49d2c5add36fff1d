#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/files/nesting.hpp>
#include <lagroid/run/files/output_folder.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <vector>

namespace lagroid {

namespace fs = std::filesystem;
using Json = nlohmann::json;

void replace_file(const fs::path& file, std::string_view bytes) {
  fs::path partial = file;
  partial += ".partial";
  write_text(bytes, partial);
  if (const int descriptor = ::open(partial.c_str(), O_RDONLY); descriptor >= 0) {
    const int lost = ::fsync(descriptor) == 0 ? 0 : errno;
    ::close(descriptor);
    // What cannot be synchronised at all says something else.
    if (lost == EIO || lost == ENOSPC || lost == EDQUOT)
      throw OutputError(fmt::format("{}: could not be written ({})", partial.string(), std::strerror(lost)));
  }
  std::error_code error;
  fs::rename(partial, file, error);
  if (error) throw OutputError(fmt::format("{}: could not be written ({})", file.string(), error.message()));
}

std::size_t sum_of(std::string_view bytes) { return std::hash<std::string_view>{}(bytes); }

void replace_by_cbor(const fs::path& file, const Json& json) {
  const std::vector<std::uint8_t> cbor = Json::to_cbor(json);
  const std::string_view body(reinterpret_cast<const char*>(cbor.data()), cbor.size());
  const std::size_t sum = sum_of(body);
  std::string bytes(sizeof sum, '\0');
  std::memcpy(bytes.data(), &sum, sizeof sum);
  replace_file(file, bytes.append(body));
}

std::optional<std::string> contents(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  try {
    return std::string{std::istreambuf_iterator<char>(in), {}};
  } catch (const std::ios_base::failure&) {
    return std::nullopt;
  }
}

std::optional<nlohmann::json> read_cbor(const fs::path& file) {
  const auto bytes = contents(file);
  std::size_t sum = 0;
  if (!bytes || bytes->size() <= sizeof sum) return std::nullopt;
  std::memcpy(&sum, bytes->data(), sizeof sum);
  const auto body = std::string_view(*bytes).substr(sizeof sum);
  if (sum_of(body) != sum) return std::nullopt;
  return parse_cbor(body);
}

}  // namespace lagroid
