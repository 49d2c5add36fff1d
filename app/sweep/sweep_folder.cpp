#include "sweep_folder.hpp"

#include "../output_folder.hpp"

#include <fmt/format.h>

#include <system_error>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

}  // namespace

fs::path PartFiles::file(long part) const { return folder_ / fmt::format("{:08}.cbor", part); }

void PartFiles::keep(long part, const Part& members) const { replace_by_cbor(file(part), members.json()); }

std::optional<Part> PartFiles::read(long part) const {
  const auto json = read_cbor(file(part));
  if (!json) return std::nullopt;
  return Part::from(*json);
}

bool PartFiles::has(long part) const {
  std::error_code ignored;
  return fs::is_regular_file(file(part), ignored);
}

void PartFiles::remove(long part) const {
  std::error_code ignored;
  fs::remove(file(part), ignored);
}

void PartFiles::remove_all() const {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

SweepFolder::SweepFolder(const fs::path& folder, const SweepScene& sweep)
    : folder_(folder), lock_(folder), parts_(folder), identity_(identity_of(sweep)), kept_(read_cbor(file())) {
  if (!kept_) return;
  const Json before = kept_->at("identity");
  if (before == identity_) return;
  const auto differs = [&](const char* key) { return before.value(key, Json()) != identity_.at(key); };
  const char* what = differs("program") ? "by another build of lagroid"
                     : differs("sweep") ? "of another sweep file, or with other overrides"
                     : differs("scene") ? "of another scene"
                                        : "of other members";
  throw RunError(
      fmt::format("--out {}: holds a sweep {}; choose another folder, or remove this one", folder.string(), what));
}

bool SweepFolder::finished() const {
  std::error_code ignored;
  return kept_ && kept_->value("finished", false) && fs::is_regular_file(folder_ / "sweep.h5", ignored);
}

void SweepFolder::restore(SweepScene& sweep) const {
  sweep.scene = parse_scene(kept_->at("scene").get<std::string>(), sweep.scene.file(), {});
  sweep.notes = kept_->at("notes").get<std::vector<std::string>>();
}

void SweepFolder::begin(const SweepScene& sweep) {
  std::error_code error;
  fs::create_directories(folder_ / "parts", error);
  if (error) throw OutputError(fmt::format("--out {}: {}; choose another place", folder_.string(), error.message()));
  if (kept_ && !kept_->value("finished", false)) return;  // else its results were taken away
  kept_ = Json{{"identity", identity_}, {"scene", sweep.scene.whole()}, {"notes", sweep.notes}};
  replace_by_cbor(file(), *kept_);
}

std::vector<long> SweepFolder::missing(const SweepScene& sweep) const {
  std::vector<long> out;
  for (long p = 0; p < sweep.parts(); ++p)
    if (!parts_.has(p)) out.push_back(p);
  return out;
}

Part SweepFolder::joined(const SweepScene& sweep) const {
  Part out;
  for (long p = 0; p < sweep.parts(); ++p) {
    const auto part = parts_.read(p);
    if (!part || part->first() != sweep.first_of(p) || part->count() != sweep.count_of(p)) {
      parts_.remove(p);
      throw RunError(fmt::format("{}: members from {} were damaged, and are taken away; run the same command again",
                                 folder_.string(), sweep.first_of(p)));
    }
    out.append(*part);
  }
  return out;
}

void SweepFolder::finish() {
  (*kept_)["finished"] = true;
  replace_by_cbor(file(), *kept_);
  parts_.remove_all();
}

}  // namespace lagroid::app
