#pragma once
/// A scene that is run while somebody watches: some steps, a look, and some more.
///
///     LiveRun run(text, {"parameters.length=2"});
///     while (run.goes_on()) run.advance(100), show(run.summary());
///
/// Requires families and systems of the program (app/families/family.hpp). A boundary value, and a scene that asks for
/// an accuracy, are solved at once where they are read. Errors: SceneError for a mistake in the scene.

#include <lagroid/run/followed_run.hpp>

#include <scenes/motion_scene.hpp>

#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lagroid::web {

class LiveRun {
 public:
  static constexpr std::size_t most_points = 5000;

  /// Of a scene with overrides "path=value"; `method` is one of those that it could be integrated by (study/), or empty
  /// for the scene's own.
  LiveRun(const std::string& text, const std::vector<std::string>& overrides, const std::string& method);

  void advance(long steps);
  bool goes_on() const { return followed_ && followed_->goes_on(); }

  /// What does not change: columns, methods, the numbers that a reader may turn, the scene with all changes, its
  /// sections, and what sections can be asked of, `within` steps.
  nlohmann::ordered_json description();
  /// What `lagroid run` writes as summary.json, of the run up to now, without the rows of events.
  std::string summary() const;
  /// The rows of a series of the trajectory; of time where there is none such.
  std::span<const double> values(std::size_t series);
  /// Where that event of the scene has happened, in the two columns of its picture, one point after another, the last
  /// `most_points`; until the next call. Touches are none.
  std::span<const double> section(std::size_t event);

 private:
  const Trajectory& trajectory() { return followed_ ? followed_->trajectory() : result_.trajectory; }
  const EventTable& happened() const { return followed_ ? followed_->happened() : result_.events; }

  app::MotionScene scene_;
  RunResult result_;
  std::optional<FollowedRun> followed_;  ///< until it has ended
  nlohmann::ordered_json turned_;
  std::string whole_;
  std::vector<double> section_;
};

}  // namespace lagroid::web
