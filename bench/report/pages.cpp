#include "pages.hpp"

#include <lagroid/run/machine.hpp>

#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace bench {

std::string file_contents(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

void put(std::string& page, const std::string& mark, const std::string& text) {
  const auto at = page.find(mark);
  if (at == std::string::npos) throw std::runtime_error("the page's template lacks " + mark);
  page.replace(at, mark.size(), text);
}

std::string machine() {
  char date[32] = "";
  const std::time_t now = std::time(nullptr);
  std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
  return fmt::format("{}, {}", lagroid::machine(), date);
}

void write_whole(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::path partial = file;
  partial += ".partial";
  std::ofstream out(partial);
  out << text;
  out.close();
  if (!out) {
    std::filesystem::remove(partial);
    throw std::runtime_error(file.string() + " could not be written; is the disk full?");
  }
  std::filesystem::rename(partial, file);
}

}  // namespace bench
