#include "../families/family.hpp"
#include "../reading/kinds.hpp"
#include "../scenes/scene_keys.hpp"
#include "formula_scene.hpp"

#include <array>
#include <utility>

namespace lagroid::app {

namespace {

/// A value of `system`, and what it stands for.
struct Word {
  std::string_view word;
  const char* about;
};
constexpr std::array formula_words{
    Word{keys::lagrangian, "any l(q, q') on R^n, written in the scene, with constraints, forces and symmetries"},
    Word{keys::hamiltonian, "any H(q, p) on T*R^n, written in the scene, with constraints and symmetries"}};

class Formulas final : public SceneFamily {
 public:
  std::string_view key() const override { return keys::system; }
  bool recognises(const Section& scene) const override {
    return !scene.has(keys::bodies) && scene.has(keys::system) &&
           is_formula_word(scene.text(keys::system, "the name of a system, as lagroid list tells them"));
  }
  MotionScene read(const Section& scene, const RunContext& context) const override {
    return read_formula(scene, context);
  }
  std::vector<Use> uses(const Section& scene) const override { return uses_of_formula(scene); }
  std::vector<ListedSystem> systems() const override {
    std::vector<ListedSystem> all;
    for (const Word& each : formula_words)
      all.push_back({std::string(each.word), each.about, "pair groupoid of R^n", {}, {}, {}});
    return all;
  }
  std::vector<std::string> names() const override {
    std::vector<std::string> all;
    for (const Word& each : formula_words) all.emplace_back(each.word);
    return all;
  }
  std::vector<SceneKeys> keys_of_scenes() const override {
    std::vector<SceneKeys> all;
    for (const auto& [word, about] : formula_words) {
      const std::string name(word);
      Table table{
          {KeyOf<OneOf>{std::string(keys::system), {{name}}, "", about},
           KeyOf<Table>{name, formula_table(word), "", "the system"},
           KeyOf<AnyTable>{"parameters", {}, "", "numbers by the names that formulas have for them", {}, "none"},
           optional_table("output", output_table(), "what is recorded")}};
      table.kinds = initial_values({KeyOf<Table>{"initial", formula_start_table(word), "", "the state to start from"}},
                                   formula_time_table(word));
      table.about = about;
      all.push_back({name, std::move(table)});
    }
    return all;
  }
};

}  // namespace

const SceneFamily& formula_family() {
  static const Formulas family;
  return family;
}

}  // namespace lagroid::app
