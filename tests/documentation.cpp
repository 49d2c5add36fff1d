// The documentation keeps up with the code: its C++ is that of the examples, what it quotes is printed.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

std::string read(const std::string& path) {
  std::ifstream file(std::string(LAGROID_ROOT) + "/" + path);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The text without the indentation of its lines.
std::string flush_left(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find_first_not_of(' ');
    out += (first == std::string::npos ? "" : line.substr(first)) + '\n';
  }
  return out;
}

/// The page's blocks in that language which are no part of `source`, indentation aside; one "no block" if it has none.
std::vector<std::string> foreign_blocks(const std::string& page, const std::string& language,
                                        const std::string& source) {
  const std::string fence = "```" + language + "\n";
  std::vector<std::string> out;
  if (page.find(fence) == std::string::npos) out.push_back("no block");
  for (auto at = page.find(fence); at != std::string::npos; at = page.find(fence, at)) {
    at += fence.size();
    const std::string block = page.substr(at, page.find("```", at) - at);
    if (flush_left(source).find(flush_left(block)) == std::string::npos) out.push_back(block);
    at += block.size() + 3;
  }
  return out;
}

/// The page's section of that heading.
std::string section(const std::string& page, const std::string& heading) {
  const auto start = page.find("\n" + heading + "\n");
  if (start == std::string::npos) throw std::runtime_error("no section " + heading);
  return page.substr(start, page.find("\n## ", start + 1) - start);
}

const std::vector<std::string> none;

TEST(Readme, ItsOwnSystemIsThatOfTheExample) {
  EXPECT_EQ(
      foreign_blocks(section(read("README.md"), "## A system of your own"), "cpp", read("examples/my_system.cpp")),
      none);
}

TEST(Tutorial, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/tutorial.md"), "cpp", read("examples/my_system.cpp")), none);
}

#ifdef LAGROID_EXAMPLE
TEST(Tutorial, WhatItQuotesIsPrinted) {
  std::FILE* pipe = ::popen(LAGROID_EXAMPLE " 2>/dev/null", "r");
  ASSERT_NE(pipe, nullptr);
  std::string printed;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) printed += char(c);
  EXPECT_EQ(::pclose(pipe), 0);
  EXPECT_EQ(foreign_blocks(read("docs/tutorial.md"), "text", printed), none);
}
#endif

TEST(BrokenPage, AnAlteredBlockIsFoundOut) {
  std::string page = read("docs/tutorial.md");
  const std::string half = "(0.5 / h)";
  page.replace(page.find(half), half.size(), "(0.6 / h)");
  EXPECT_EQ(foreign_blocks(page, "cpp", read("examples/my_system.cpp")).size(), 1U);
  EXPECT_EQ(foreign_blocks("no code", "cpp", "any").size(), 1U);
}

}  // namespace
