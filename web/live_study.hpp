#pragma once
/// What accuracy costs, measured while somebody watches: one run of one method at a time, with smaller and smaller
/// steps.
///
///     LiveStudy study(text, {});
///     study.look_for_reference(2);
///     while (auto point = study.next()) draw(point->error, point->seconds);
///
/// Requires an initial-value scene. Errors: SceneError for a mistake in the scene, std::domain_error where there is
/// nothing to compare with.

#include <lagroid/run/study/measure.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::web {

class LiveStudy {
 public:
  LiveStudy(const std::string& text, const std::vector<std::string>& overrides);

  /// Of each order that with the fewest stages, and those that are there to be compared with.
  const std::vector<Method>& methods() const { return methods_; }
  /// Finds, in about so many seconds, the state at the end that runs are compared with. Returns how well it is known.
  double look_for_reference(double seconds);
  /// The next run, of all methods in turn; nothing where smaller steps would gain nothing or take too long.
  std::optional<Measurement> next();

 private:
  /// How far a method has come.
  struct Descent {
    double step = 0;
    double least = 0;  ///< error
    int in_vain = 0;
    bool done = false;
  };
  Measurement measure(std::size_t which);

  Experiment experiment_;
  std::vector<Method> methods_;
  std::unique_ptr<Reference> reference_;
  std::vector<Descent> descents_;
  std::size_t turn_ = 0;
};

}  // namespace lagroid::web
