#include "sweep_folder.hpp"

#include "sweep_files.hpp"

#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/machine.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <system_error>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Whether a file is a part, or was to become one.
bool is_part(const fs::path& file) {
  const std::string name = file.filename().string();
  const auto digits = name.find_first_not_of("0123456789");
  return digits != 0 && digits != std::string::npos &&
         (name.substr(digits) == ".cbor" || name.substr(digits) == ".cbor.partial");
}

/// Whether it holds what `SweepFolder` keeps.
bool is_of_a_sweep(const Json& kept) {
  const auto is = [&](const char* key, bool (Json::*kind)() const noexcept, bool needed) {
    return kept.contains(key) ? (kept[key].*kind)() : !needed;
  };
  return kept.is_object() && is("program", &Json::is_string, true) && is("scene", &Json::is_string, true) &&
         is("notes", &Json::is_array, true) && is("finished", &Json::is_boolean, false) &&
         is("results", &Json::is_object, false);
}

/// What a file amounts to: its size, and of those that fit into memory without a thought its bytes.
Json amount_of(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error) return nullptr;
  constexpr std::uintmax_t most_looked_at = 1 << 26;
  return {std::uint64_t(size), size <= most_looked_at ? sum_of(contents(file).value_or("")) : 0};
}

/// What a sweep leaves beside its pictures.
constexpr std::array results{"sweep.h5", "members.csv", "summary.json", "summary.txt"};

}  // namespace

fs::path PartFiles::file(long part) const { return folder_ / fmt::format("{:08}.cbor", part); }

void PartFiles::keep(long part, const SweepPart& members) const { replace_by_cbor(file(part), members.json()); }

std::optional<SweepPart> PartFiles::read(long part) const {
  const auto json = read_cbor(file(part));
  if (!json) return std::nullopt;
  return SweepPart::from(*json);
}

bool PartFiles::has(long part) const {
  std::error_code ignored;
  return fs::is_regular_file(file(part), ignored);
}

void PartFiles::remove(long part) const {
  std::error_code ignored;
  fs::remove(file(part), ignored);
}

bool PartFiles::any() const {
  std::error_code ignored;
  const fs::directory_iterator files(folder_, ignored);
  return std::any_of(begin(files), end(files), [](const auto& entry) { return is_part(entry.path()); });
}

void PartFiles::remove_all() const {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_, ignored))
    if (is_part(entry.path())) fs::remove(entry.path(), ignored);
  fs::remove(folder_, ignored);  // not where there is something else in it
}

SweepFolder::SweepFolder(const fs::path& folder, const SweepScene& sweep, bool other_build)
    : folder_(folder),
      held_(folder, OutputKind::sweep, source_of(sweep), sweep_files),
      parts_(folder),
      kept_(read_cbor(file())) {
  if ((kept_ && !held_.known()) || (!kept_ && parts_.any())) {
    held_.disown();
    throw RunError(
        fmt::format("--out {}: holds parts of a sweep, but {}, which says of which one, is missing or damaged; choose "
                    "another folder, or remove this one",
                    folder.string(), kept_ ? ".lagroid" : file().filename().string()));
  }
  if (!kept_) return;
  if (!is_of_a_sweep(*kept_))
    throw RunError(fmt::format("{}: is damaged; choose another folder, or remove this one", file().string()));
  if (finished()) parts_.remove_all();  // whoever finished it may have been killed before
  const std::string made_by = kept_->value("program", "");
  if (made_by == program()) return;
  if (!other_build)
    throw RunError(
        fmt::format("--out {}: holds a sweep by another build of lagroid ({}; this one is {}); choose another folder, "
                    "or let --other-build go on without the promise of the same bits",
                    folder.string(), made_by, program()));
  (*kept_)["program"] = program();
  (*kept_)["notes"].push_back(
      fmt::format("goes on from another build ({}), without the promise of the same bits", made_by));
  if (!finished()) replace_by_cbor(file(), *kept_);
}

bool SweepFolder::finished() const {
  if (!kept_ || !kept_->value("finished", false)) return false;
  const Json left = kept_->value("results", Json::object());
  return !left.empty() && std::all_of(results.begin(), results.end(), [&](const char* name) {
    return left.contains(name) && left[name] == amount_of(folder_ / name);
  });
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
  kept_ = Json{{"program", program()}, {"scene", sweep.scene.whole()}, {"notes", sweep.notes}};
  replace_by_cbor(file(), *kept_);
}

std::vector<long> SweepFolder::missing(const SweepScene& sweep) const {
  std::vector<long> out;
  for (long p = 0; p < sweep.parts(); ++p)
    if (!parts_.has(p)) out.push_back(p);
  return out;
}

SweepPart SweepFolder::joined(const SweepScene& sweep) const {
  SweepPart out;
  long damaged = 0;
  for (long p = 0; p < sweep.parts(); ++p) {
    const auto part = parts_.read(p);
    if (!part || part->first() != sweep.first_of(p) || part->count() != sweep.count_of(p)) {
      parts_.remove(p);
      ++damaged;
    } else if (damaged == 0) {
      out.append(*part);
    }
  }
  if (damaged > 0)
    throw RunError(fmt::format("{}: {} of {} parts were damaged, and are taken away; run the same command again",
                               folder_.string(), damaged, sweep.parts()));
  return out;
}

void SweepFolder::finish() {
  (*kept_)["finished"] = true;
  for (const char* name : results) (*kept_)["results"][name] = amount_of(folder_ / name);
  replace_by_cbor(file(), *kept_);
  parts_.remove_all();
}

}  // namespace lagroid::app
