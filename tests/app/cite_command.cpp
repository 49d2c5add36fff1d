// `lagroid cite`: what a scene rests on, in every form, and CITATION.cff.
#include "command_line.hpp"

#include <lagroid/core/version.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace app_cite_command_tests {
namespace {

class Cite : public CommandLine {
 protected:
  /// The keys of what is cited.
  std::vector<std::string> cited(const std::string& arguments) const {
    const Outcome r = run("cite " + arguments + " --json");
    EXPECT_EQ(r.code, 0) << r.err;
    std::vector<std::string> keys;
    const auto json = nlohmann::json::parse(r.out);
    for (const auto& reference : json.at("references")) {
      keys.push_back(reference.at("key"));
      EXPECT_FALSE(reference.at("for").get<std::string>().empty());
    }
    return keys;
  }
  static std::string file(const std::string& name) {
    std::ifstream in(name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

using Keys = std::vector<std::string>;

TEST_F(Cite, SaysWhatASceneRestsOn) {
  EXPECT_EQ(cited(example("kepler")), (Keys{"marrero2015", "owren2000"}));
  EXPECT_EQ(cited(example("kepler") + " --set time.method=splitting"), Keys{"marrero2015"});
  EXPECT_EQ(cited(example("kepler") + " --set solver.method=ceres"), Keys{"marrero2015"});
  EXPECT_EQ(cited(example("kepler_adaptive")), (Keys{"marrero2015", "kane1999", "owren2000"}));
  EXPECT_EQ(cited(example("kepler") + " --set time.order=4"), (Keys{"marrero2015", "suzuki1990", "owren2000"}));
  EXPECT_EQ(cited(example("kepler") + " --set time.method=splitting --set time.composition=nystrom-6"),
            (Keys{"marrero2015", "blanes2002"}));
  EXPECT_EQ(cited(example("kepler") + " --set time.mode=transformed --set time.order=8"),
            (Keys{"marrero2015", "mikkola1999", "kahan1997"}));
  EXPECT_EQ(cited(example("chain_drop") + " --set time.order=6"), (Keys{"marrero2015", "kahan1997"}));
  EXPECT_EQ(cited(example("rigid_body_moser_veselov")), (Keys{"marrero2015", "hairer2006"}));
  EXPECT_EQ(cited(example("rolling_disk")), (Keys{"marrero2015", "iglesias2008", "owren2000"}));
  EXPECT_EQ(cited(example("chain_drop")), Keys{"marrero2015"});
  EXPECT_EQ(cited(example("rolling_balls")), (Keys{"marrero2015", "iglesias2008"}));
  EXPECT_EQ(cited(example("sweeps/basins")), (Keys{"marrero2015", "owren2000"}));
  EXPECT_EQ(cited(example("pendulum_chain")), Keys{"marrero2015"});
  EXPECT_EQ(cited(example("pendulum_chain") + " --set time.method=munthe-kaas-54"),
            (Keys{"celledoni2022", "munthe-kaas1999"}));
  EXPECT_EQ(cited(example("pendulum_chain") + " --set time.method=runge-kutta-4"), Keys{});
  EXPECT_EQ(cited(example("pendulum_chain") + " --set time.order=4"), (Keys{"marrero2015", "suzuki1990"}));
  EXPECT_EQ(cited(example("learned_hamiltonian")), (Keys{"celledoni2023", "celledoni2022", "celledoni2003"}));
  EXPECT_EQ(cited(example("stochastic_top")), (Keys{"cosserat2024", "milstein2002", "arnaudon2018"}));
  EXPECT_EQ(cited(example("optimisation/membrane")), Keys{"duruisseaux2022"});
  EXPECT_EQ(cited(example("optimisation/membrane") + " --set method.name=trust-region"), Keys{});
}

TEST_F(Cite, OfAFolderWhatIsInIt) {
  const std::string folder = (folder_ / "out").string();
  ASSERT_EQ(run("run " + example("kepler") + " --set time.steps=10 --out " + folder).code, 0);
  EXPECT_EQ(cited(folder), (Keys{"marrero2015", "owren2000"}));
  const fs::path learned = folder_ / "learned";
  fs::create_directories(learned);
  std::ofstream(learned / "model.json") << "{}";
  EXPECT_EQ(cited(learned.string()), Keys{"celledoni2023"});
}

TEST_F(Cite, EveryFormHoldsTheSame) {
  const auto json = nlohmann::json::parse(run("cite --json").out);
  const std::string text = run("cite").out;
  const std::string bibtex = run("cite --bibtex").out;
  EXPECT_EQ(json.at("software").at("version"), LAGROID_VERSION);
  EXPECT_NE(bibtex.find("version = {" LAGROID_VERSION "}"), std::string::npos);
  for (const auto& reference : json.at("references"))
    for (const std::string& form : {text, bibtex})
      for (const char* what : {"title", "doi", "journal"})
        EXPECT_NE(form.find(reference.at(what).get<std::string>()), std::string::npos) << reference;
  EXPECT_EQ(std::count(bibtex.begin(), bibtex.end(), '{'), std::count(bibtex.begin(), bibtex.end(), '}'));
  EXPECT_EQ(std::count(bibtex.begin(), bibtex.end(), '@'), long(json.at("references").size()) + 1);
}

TEST_F(Cite, TheCitationFileIsWhatItPrints) {
  EXPECT_EQ(run("cite --cff").out, file(LAGROID_CITATION)) << "write it anew: ./lagroid cite --cff > CITATION.cff";
}

TEST_F(Cite, RefusesWhatItCannotRead) {
  for (const std::string& wrong :
       {std::string("nowhere.toml"), folder_.string(), example("kepler") + " --set system=nothing",
        example("kepler") + " --set time.method=eular", example("kepler") + " --set time.method=moser-veselov",
        example("pendulum_chain") + " --set time.method=eular", std::string("--json --bibtex")})
    expect_refused("cite " + wrong);
}

}  // namespace
}  // namespace app_cite_command_tests
