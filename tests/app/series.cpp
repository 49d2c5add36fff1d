// Columns of HDF5 files: those of runs, and of whoever else writes them.
#include <lagroid/run/files/hdf5_file.hpp>
#include <reading/data_set.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace lagroid;
using namespace lagroid::app;

namespace app_series_tests {
namespace {

class SeriesOfAFile : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = std::filesystem::temp_directory_path() /
            (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".h5");
  }
  void TearDown() override { std::filesystem::remove(file_); }

  std::vector<RecordedSeries> read() {
    std::vector<RecordedSeries> out;
    read_series(file_, [&](const std::vector<double>& time, const RecordedSeries& series) {
      time_ = time;
      out.push_back(series);
    });
    return out;
  }
  std::string refusal() {
    try {
      read();
    } catch (const DataError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path file_;
  std::vector<double> time_;
};

TEST_F(SeriesOfAFile, OfOnesOwnAreNamedByTheirDataSets) {
  write_hdf5(file_, [](const H5::H5File& out) {
    add_dataset(out, "t", {0, 0.5, 1}, 1);
    add_dataset(out, "angle", {1, 2, 3}, 1);
    add_dataset(out, "x", {1, 2, 3, 4, 5, 6}, 2);
    add_texts(out, "who", {"I"});
    add_dataset(out.createGroup("notes"), "others", {7}, 1);
  });
  ASSERT_TRUE(is_hdf5(file_));
  const auto found = read();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(time_, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(found[0].columns, std::vector<std::string>{"angle"});
  EXPECT_EQ(found[1].columns, (std::vector<std::string>{"x.0", "x.1"}));
  EXPECT_EQ(found[1].at(2, 1), 6);
}

TEST_F(SeriesOfAFile, OfARunBeginWithTheirFirstArrow) {
  write_hdf5(file_, [](const H5::H5File& out) {
    set_attribute(out, "generator", "lagroid");
    add_dataset(out, "time", {0, 0.5, 1}, 1);
    const H5::DataSet set = add_dataset(out, "multipliers", {8, 9}, 1);
    set_attribute(set, "components", "lambda");
    set_attribute(set, "rows", "one per recorded arrow");
  });
  const auto found = read();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].columns, std::vector<std::string>{"lambda"});
  EXPECT_TRUE(std::isnan(found[0].at(0, 0)));
  EXPECT_EQ(found[0].at(1, 0), 8);
  EXPECT_EQ(found[0].at(2, 0), 9);
}

TEST_F(SeriesOfAFile, ThatDoNotFitAreRefusedInALine) {
  write_hdf5(file_, [](const H5::H5File& out) { add_dataset(out, "q", {1, 2}, 1); });
  EXPECT_NE(refusal().find("no data set time, or t"), std::string::npos) << refusal();
  write_hdf5(file_, [](const H5::H5File& out) {
    add_dataset(out, "t", {0, 1}, 1);
    add_dataset(out, "q", {1, 2, 3}, 1);
  });
  EXPECT_NE(refusal().find("\"q\" has another number of rows than t"), std::string::npos) << refusal();
  std::ofstream(file_) << "t,q\n0,1\n";
  EXPECT_FALSE(is_hdf5(file_));
  EXPECT_NE(refusal().find("HDF5"), std::string::npos) << refusal();
  std::filesystem::remove(file_);
  EXPECT_FALSE(is_hdf5(file_));
}

}  // namespace
}  // namespace app_series_tests
