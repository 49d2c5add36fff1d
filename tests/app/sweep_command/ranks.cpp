// Sweeps on threads and ranks, interrupted and killed: the same bytes.
#include "sweep.hpp"

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <fstream>
#include <random>
#include <string>

namespace lagroid::sweep_tests::ranks_tests {
namespace {

TEST_F(Sweep, ThreadsAndPartsLeaveTheSameBytes) {
  const std::string file = orbits(square);
  ASSERT_EQ(sweep(file, "one", "--threads 1").code, 0);
  ASSERT_EQ(sweep(file, "two", "--threads 2").code, 0);
  ASSERT_EQ(sweep(file, "seven", "--threads 7").code, 0);
  expect_same("one", "two");
  expect_same("one", "seven");
  ASSERT_EQ(sweep(file, "whole", "--set run.part=4").code, 0);
  EXPECT_TRUE(bytes(out("one") + "/members.csv") == bytes(out("whole") + "/members.csv"));
}

TEST_F(Sweep, AnInterruptKeepsWhatIsFinishedAndTheSameCommandGoesOn) {
  const std::string file =
      orbits(random_design("random", 60, "[[vary]]\nkey = \"initial.momentum.1\"\nfrom = 1.5\nto = 2\n"), 20000);
  ASSERT_EQ(sweep(file, "whole").code, 0);
  const std::string command = std::string(LAGROID_PROGRAM) + " sweep " + file + " --out " + out("broken");
  const pid_t child = start(command);
  wait_for_parts("broken", 3);
  kill(child, SIGTERM);
  EXPECT_EQ(wait_for(child), 4);
  EXPECT_GE(parts("broken"), 3U);
  EXPECT_LT(parts("broken"), 60U);
  EXPECT_FALSE(fs::exists(out("broken") + "/sweep.h5"));
  // Another sweep has no place there.
  const Outcome other = sweep(file, "broken", "--set design.count=61");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("holds a sweep of another sweep file"), std::string::npos) << other.err;
  // Nor have parts of which nobody knows the sweep.
  fs::rename(out("broken") + "/sweep.cbor", out("aside"));
  const Outcome unknown = sweep(file, "broken");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("sweep.cbor"), std::string::npos) << unknown.err;
  fs::rename(out("aside"), out("broken") + "/sweep.cbor");
  // A part that was damaged is noticed, and run again.
  const fs::path part = fs::directory_iterator(out("broken") + "/parts")->path();
  std::ofstream(part, std::ios::app) << "x";
  const Outcome damaged = sweep(file, "broken");
  EXPECT_EQ(damaged.code, 2);
  EXPECT_NE(damaged.err.find("run the same command again"), std::string::npos) << damaged.err;
  const Outcome r = sweep(file, "broken");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("kept from before"), std::string::npos) << r.out;
  expect_same("whole", "broken");
}

TEST_F(Sweep, RanksLeaveTheSameBytes) {
  if (const std::string why = without_ranks(); !why.empty()) GTEST_SKIP() << why;
  const std::string file = orbits(
      random_design("latin-hypercube", 100, "[[vary]]\nkey = \"initial.momentum.1\"\nfrom = 0.5\nto = 2\n"), 300);
  ASSERT_EQ(sweep(file, "alone").code, 0);
  for (const int ranks : {1, 2, 4}) {
    const std::string name = "ranks" + std::to_string(ranks);
    const Outcome r = run("sweep " + file + " --threads 2 --out " + out(name), mpirun(ranks));
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(r.out.find("latin-hypercube"), r.out.rfind("latin-hypercube"));  // told once
    expect_same("alone", name);
  }
  // One line from one rank, where there is something wrong.
  const Outcome wrong = run("sweep " + file + " --out " + out("no") + " --set design.kind=cube", mpirun(3));
  EXPECT_EQ(wrong.code, 2);
  const auto at = wrong.err.find("lagroid: ");
  EXPECT_EQ(at, wrong.err.rfind("lagroid: ")) << wrong.err;
}

TEST_F(Sweep, NoiseHasTheSameBitsOnAnyNumberOfRanks) {
  if (const std::string why = without_ranks(); !why.empty()) GTEST_SKIP() << why;
  const std::string paths = file("paths.toml", "[scene]\nfile = \"" + example("stochastic_top") +
                                                   "\"\ntime.steps = 200\n[design]\nkind = \"grid\"\n[[vary]]\nkey = "
                                                   "\"noise.path\"\nvalues = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n");
  for (const int ranks : {1, 4}) {
    const std::string name = "ranks" + std::to_string(ranks);
    const Outcome r = run("sweep " + paths + " --threads 1 --out " + out(name), mpirun(ranks));
    EXPECT_EQ(r.code, 0) << r.err;
  }
  expect_same("ranks1", "ranks4");
  // They are other paths.
  const Table table = members("ranks4");
  const auto final =
      std::find_if(table.begin(), table.end(), [](const auto& column) { return column.first.ends_with("M1"); });
  ASSERT_NE(final, table.end());
  EXPECT_NE(final->second.at(0), final->second.at(1));
}

#ifdef LAGROID_MANY_KILLS
constexpr int kills = 20;
#else
constexpr int kills = 2;
#endif

TEST_F(Sweep, AKilledRankLosesNothingAfterTheRerun) {
  if (const std::string why = without_ranks(); !why.empty()) GTEST_SKIP() << why;
  const std::string file =
      orbits(random_design("random", 60, "[[vary]]\nkey = \"initial.momentum.1\"\nfrom = 1.5\nto = 2\n"), 20000);
  ASSERT_EQ(sweep(file, "whole").code, 0);
  std::mt19937 random(20261123);
  for (int i = 0; i < kills; ++i) {
    const std::string name = "killed" + std::to_string(i);
    const std::string pid = out("pid");
    const std::string command = mpirun(3) + "sh -c 'echo $$ > " + pid + ".$OMPI_COMM_WORLD_RANK; exec " +
                                LAGROID_PROGRAM + " sweep " + file + " --threads 1 --out " + out(name) + "'";
    const pid_t job = start("env " + command);
    const std::size_t before = 1 + random() % 30;
    wait_for_parts(name, before);
    std::ifstream victim(pid + "." + std::to_string(random() % 3));
    pid_t rank = 0;
    victim >> rank;
    ASSERT_GT(rank, 1);
    kill(rank, SIGKILL);
    EXPECT_NE(wait_for(job), 0);
    EXPECT_GE(parts(name), before);
    const Outcome r = i % 2 == 0 ? sweep(file, name) : run("sweep " + file + " --out " + out(name), mpirun(2));
    EXPECT_EQ(r.code, 0) << r.err;
    expect_same("whole", name);
    fs::remove_all(out(name));
  }
}

}  // namespace
}  // namespace lagroid::sweep_tests::ranks_tests
