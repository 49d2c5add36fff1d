#include "checkpoint.hpp"

#include "output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string_view>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The file as a whole, on the disk, or the one that was there before.
void replace(const fs::path& file, std::string_view bytes) {
  fs::path partial = file;
  partial += ".partial";
  write_text(bytes, partial);
  if (const int descriptor = ::open(partial.c_str(), O_RDONLY); descriptor >= 0) {
    ::fsync(descriptor);
    ::close(descriptor);
  }
  std::error_code error;
  fs::rename(partial, file, error);
  if (error) throw OutputError(fmt::format("{}: could not be written ({})", file.string(), error.message()));
}

void replace_by_cbor(const fs::path& file, const Json& json) {
  const std::vector<std::uint8_t> bytes = Json::to_cbor(json);
  replace(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Json read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  Json json = Json::from_cbor(bytes, /*strict=*/true, /*allow_exceptions=*/false);
  if (!in || json.is_discarded())
    throw RunError(fmt::format("{}: is missing or damaged; run the scene again", file.string()));
  return json;
}

}  // namespace

Checkpoint::Checkpoint(const fs::path& run, long steps) : folder_(run / "checkpoint"), steps_(steps) {
  std::error_code error;
  fs::create_directories(run, error);
  const fs::path file = run / ".lock";
  lock_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  const bool busy = lock_ >= 0 && errno == EWOULDBLOCK;
  if (lock_ >= 0) ::close(lock_);
  throw OutputError(
      busy ? fmt::format("{}: another run is at work there; wait for it, or choose another folder", run.string())
           : fmt::format("{}: cannot be written; choose another place", file.string()));
}

Checkpoint::~Checkpoint() { ::close(lock_); }

fs::path Checkpoint::part(long k) const { return folder_ / fmt::format("rows-{:06}.cbor", k); }

void Checkpoint::begin(const std::string& scene) {
  std::error_code error;
  fs::remove_all(folder_, error);
  fs::create_directories(folder_, error);
  if (error) throw OutputError(fmt::format("{}: cannot be made ({})", folder_.string(), error.message()));
  replace(folder_ / "scene.toml", scene);
}

void Checkpoint::remove(const fs::path& run) {
  std::error_code ignored;
  fs::remove_all(run / "checkpoint", ignored);
}

std::string Checkpoint::scene_of(const fs::path& run) {
  const fs::path file = run / "checkpoint" / "scene.toml";
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in)
    throw RunError(fmt::format("{}: holds no run that can be taken up; lagroid run SCENE --out {} makes one",
                               run.string(), run.string()));
  return text;
}

Json Checkpoint::restore(Trajectory& trajectory) {
  const Json json = read(folder_ / "state.cbor");
  try {
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
    return json.at("state");
  } catch (const Json::exception&) {
    throw RunError(fmt::format("{}: is damaged, or of another lagroid; run the scene again", folder_.string()));
  }
}

bool Checkpoint::due(long step) const {
  if (steps_ > 0) return step % steps_ == 0;
  // Looking at the clock costs as much as a small step.
  return step % 64 == 0 && std::chrono::steady_clock::now() - last_ > std::chrono::duration<double>(seconds);
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
  replace_by_cbor(folder_ / "state.cbor", Json{{"parts", parts_}, {"state", state}});
  rows_ = trajectory.time.size();
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = trajectory.series[i].values.size();
  last_ = std::chrono::steady_clock::now();
}

}  // namespace lagroid::app
