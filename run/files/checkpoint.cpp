#include <lagroid/core/version.hpp>
#include <lagroid/run/files/checkpoint.hpp>
#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/files/program_scene.hpp>
#include <lagroid/run/machine.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <string>
#include <utility>

namespace lagroid {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Json read(const fs::path& file) {
  if (auto json = read_cbor(file)) return std::move(*json);
  throw RunError(fmt::format("{}: is missing or damaged; run the scene again", file.string()));
}

/// Whether a file is one of a checkpoint, or was to become one.
bool is_of_a_checkpoint(const std::string& name) {
  static const std::regex names(R"((scene\.toml|state\.cbor|rows-[0-9]{6,}\.cbor)(\.partial)?)");
  return std::regex_match(name, names);
}

/// As in "0.3": checkpoints differ between these.
std::string minor_version() { return fmt::format("{}.{}", LAGROID_VERSION_MAJOR, LAGROID_VERSION_MINOR); }

}  // namespace

Checkpoint::Checkpoint(const fs::path& run, long steps) : folder_(run / "checkpoint"), steps_(steps) {}

fs::path Checkpoint::part(long k) const { return folder_ / fmt::format("rows-{:06}.cbor", k); }

void Checkpoint::remove() {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_, ignored))
    if (is_of_a_checkpoint(entry.path().filename().string())) fs::remove(entry.path(), ignored);
  fs::remove(folder_, ignored);  // where nothing of a user's is in it
}

void Checkpoint::begin(const std::string& scene) {
  std::error_code error;
  if (fs::is_symlink(folder_, error))
    throw FolderRefused(fmt::format(
        "{}: is a link, and what it leads to would be lost; remove it, or choose another folder", folder_.string()));
  remove();
  fs::create_directories(folder_, error);
  if (error) throw OutputError(fmt::format("{}: cannot be made ({})", folder_.string(), error.message()));
  replace_file(folder_ / "scene.toml", scene);
  scene_ = sum_of(scene);
}

std::string Checkpoint::how_to_resume(std::string_view scene, const fs::path& run) {
  if (is_of_a_program(scene)) return "the program with RunOptions::resume";
  return fmt::format("lagroid resume {}", run.string());
}

std::string Checkpoint::scene_of(const fs::path& run) {
  std::string text = text_of(run);
  if (is_of_a_program(text))
    throw RunError(
        fmt::format("{}: is a run of a program of one's own, which alone knows its system; start that program "
                    "again, with RunOptions::resume",
                    run.string()));
  return text;
}

std::string Checkpoint::text_of(const fs::path& run) {
  if (auto text = contents(run / "checkpoint" / "scene.toml")) return *std::move(text);
  throw RunError(
      fmt::format("\"{}\" holds no run that can be taken up; a run that writes into a folder makes one", run.string()));
}

void Checkpoint::require_this_build(const fs::path& run, bool other_build) {
  const Json json = read(run / "checkpoint" / "state.cbor");
  const bool says = json.is_object() && json.contains("program") && json["program"].is_string();
  const std::string made_by = says ? json["program"].get<std::string>() : "an earlier lagroid";
  if (made_by == program()) return;
  std::smatch found;
  const bool numbered = std::regex_search(made_by, found, std::regex(R"(lagroid ((\d+\.\d+)\.\d+))"));
  if (numbered && found[2] != minor_version())
    throw RunError(
        fmt::format("{}: its checkpoint was made by lagroid {}, and this one, {}, reads none of those; run the "
                    "scene again (what is there can still be drawn and viewed)",
                    run.string(), found[1].str(), LAGROID_VERSION));
  if (other_build) return;
  throw RunError(
      fmt::format("{}: its checkpoint was made by another build of lagroid ({}; this one is {}); run the scene again, "
                  "or let resume --other-build go on without the promise of the same bits",
                  run.string(), made_by, program()));
}

Json Checkpoint::restore(Trajectory& trajectory) {
  const Json json = read(folder_ / "state.cbor");
  try {
    scene_ = json.at("scene").get<std::size_t>();
    if (sum_of(contents(folder_ / "scene.toml").value_or("")) != scene_)
      throw RunError(fmt::format("{}: is not the scene that was run; run it anew, in a folder of its own",
                                 (folder_ / "scene.toml").string()));
    const long parts = json.at("parts").get<long>();
    for (; parts_ < parts; ++parts_) {
      const Json rows = read(part(parts_));
      const auto append = [](std::vector<double>& to, const Json& from) {
        const auto values = from.get<std::vector<double>>();
        to.insert(to.end(), values.begin(), values.end());
      };
      append(trajectory.time, rows.at("time"));
      const Json& series = rows.at("series");
      if (series.size() != trajectory.series.size())
        throw RunError(fmt::format("{}: holds other columns than this lagroid records; run the scene again",
                                   part(parts_).string()));
      for (std::size_t i = 0; i < series.size(); ++i) append(trajectory.series[i].values, series[i]);
    }
    rows_ = trajectory.time.size();
    for (const auto& s : trajectory.series) values_.push_back(s.values.size());
    others_ = json.value("others", others_);
    if (const std::string made_by = json.value("program", "an earlier lagroid"); made_by != program())
      others_.push_back(made_by);
    return json.at("state");
  } catch (const Json::exception&) {
    throw RunError(fmt::format("{}: is damaged, or of another lagroid; run the scene again", folder_.string()));
  }
}

bool Checkpoint::due(long step) {
  if (steps_ > 0) return step % steps_ == 0;
  // Looking at the clock costs as much as a small step: it is looked at about every millisecond.
  if (--until_look_ > 0) return false;
  constexpr std::chrono::milliseconds look(1);
  const auto now = std::chrono::steady_clock::now();
  stride_ = now - looked_ > look ? std::max(stride_ / 2, 1L) : std::min(2 * stride_, 1024L);
  until_look_ = stride_;
  looked_ = now;
  return now - last_ > std::chrono::duration<double>(seconds);
}

void Checkpoint::keep(const Trajectory& trajectory, const Json& state) {
  const auto from = [](const std::vector<double>& all, std::size_t first) {
    return Json(std::vector<double>(all.begin() + std::ptrdiff_t(first), all.end()));
  };
  values_.resize(trajectory.series.size(), 0);
  if (trajectory.time.size() > rows_) {
    Json series = Json::array();
    for (std::size_t i = 0; i < values_.size(); ++i) series.push_back(from(trajectory.series[i].values, values_[i]));
    replace_by_cbor(part(parts_++), Json{{"time", from(trajectory.time, rows_)}, {"series", series}});
  }
  replace_by_cbor(
      folder_ / "state.cbor",
      Json{{"parts", parts_}, {"scene", scene_}, {"program", program()}, {"others", others_}, {"state", state}});
  rows_ = trajectory.time.size();
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = trajectory.series[i].values.size();
  last_ = std::chrono::steady_clock::now();
}

}  // namespace lagroid
