#include "new_folder.hpp"

#include "../command/command_of.hpp"
#include "templates.hpp"

#include <lagroid/core/version.hpp>
#include <lagroid/run/files/output_folder.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <boost/algorithm/string/replace.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using Words = std::map<std::string, std::string>;

/// A groupoid that a new system can be on.
struct Offered {
  std::string_view name;
  std::string_view header;  ///< as it is included
  std::string_view type;
  std::string_view words;
  int dimension;
  std::string_view initial;
  bool at_points;  ///< its objects are points, on which a potential may depend
};
constexpr std::array offered{
    Offered{"pair", "<lagroid/groupoids/pair.hpp>", "Pair<2>", "the pair groupoid of the plane", 2,
            "position = [1.0, 0.0]\nmomentum = [0.0, 0.5]", true},
    Offered{"so3", "<lagroid/groupoids/groups/so3.hpp>", "SO3", "the rotations SO(3)", 3,
            "attitude = [1.0, 0.0, 0.0, 0.0]\nmomentum = [0.1, 1.0, 0.1]", false},
    Offered{"so2", "<lagroid/groupoids/groups/so2.hpp>", "SO2", "the rotations of the plane", 1, "momentum = [1.0]",
            false},
    Offered{"se2", "<lagroid/groupoids/groups/se2.hpp>", "SE2", "the motions SE(2) of the plane", 3,
            "position = [0.0, 0.0, 0.0]    # x, y, heading\nmomentum = [0.5, 1.0, 0.1]", false},
    Offered{"vector", "<lagroid/groupoids/groups/vector_group.hpp>", "VectorGroup<2>", "the plane as a group", 2,
            "position = [0.0, 0.0]\nmomentum = [1.0, 0.5]", false}};

std::string filled(std::string_view text, const Words& words) {
  std::string out(text);
  for (const auto& [key, value] : words) boost::replace_all(out, "@" + key + "@", value);
  return out;
}

/// spring_pendulum as SpringPendulum.
std::string class_name(const std::string& name) {
  std::string out;
  bool begins = true;
  for (const char c : name) {
    if (c != '_') out += begins ? char(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '_';
  }
  return out;
}

/// Whether the class would be taken for one of the library's, of which the source sees all.
bool is_taken(const std::string& of_class) {
  constexpr std::array<std::string_view, 24> taken{
      "Action", "Capabilities", "Dual",  "Forces", "Integrator", "Ledger",  "Matrix",     "Module",
      "Motion", "Pack",         "Pair",  "Panel",  "Path",       "Product", "Quantity",   "Scaling",
      "Shape",  "Stage",        "State", "Step",   "Symmetry",   "System",  "Trajectory", "Vector"};
  return std::ranges::find(taken, of_class) != taken.end();
}

bool is_name(const std::string& name) {
  const auto small = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && small(name[0]) &&
         std::ranges::all_of(name, [&](char c) { return small(c) || (c >= '0' && c <= '9') || c == '_'; });
}

Words words_of_system(const std::string& name, const Offered& on) {
  const std::vector<std::string> ones(std::size_t(on.dimension), "1.0");
  Words words{{"name", name},
              {"class", class_name(name)},
              {"header", std::string(on.header)},
              {"groupoid", std::string(on.type)},
              {"groupoid_words", std::string(on.words)},
              {"inertia_numbers", fmt::format("[{}]", fmt::join(ones, ", "))},
              {"initial", std::string(on.initial)},
              {"version", fmt::format("{}.{}", LAGROID_VERSION_MAJOR, LAGROID_VERSION_MINOR)},
              {"lagrangian_words", "L(g) = <x, M x> / 2h,"}};
  for (const char* key : {"members", "more_parameters", "potential", "parameter_lines"}) words[key] = "";
  if (on.at_points) {
    const std::string of = class_name(name);
    words["lagrangian_words"] =
        "L(g) = <x, M x> / 2h - h (V(q) + V(q')) / 2 on an arrow from q to q', V = k |q|^2 / 2,\n//";
    words["members"] =
        "  double stiffness = 1;                                                    // k\n\n"
        "  template <class S, int N> S potential(const Vector<S, N>& q) const {\n"
        "    return q.squaredNorm() * (varied<S>(stiffness) * 0.5);\n  }\n";
    words["more_parameters"] = fmt::format(
        ",\n                      parameter(\"stiffness\", &{}::stiffness, \"N/m\", \"of the spring to the origin\")",
        of);
    words["potential"] = " - (potential(groupoid.source(g)) + potential(groupoid.target(g))) * 0.5 * step";
    words["parameter_lines"] = "stiffness = 1.0\n";
  }
  return words;
}

struct NewOptions {
  std::string what;
  std::string name;
  std::string groupoid = std::string(offered[0].name);
  std::string folder;
};

/// The folder with its files, all or none of them.
void write_folder(const fs::path& folder, const std::vector<std::pair<std::string, std::string>>& files) {
  if (fs::exists(folder)) throw FolderRefused(fmt::format("{}: is there already; give another name", folder.string()));
  std::string made = (folder.parent_path() / ("." + folder.filename().string() + "-XXXXXX")).string();
  if (::mkdtemp(made.data()) == nullptr)
    throw FolderRefused(fmt::format("{}: {}", folder.string(), std::generic_category().message(errno)));
  try {
    fs::permissions(made,
                    fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec,
                    fs::perm_options::add);
    for (const auto& [name, text] : files) write_text(text, fs::path(made) / name);
    fs::rename(made, folder);
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(made, ignored);
    throw;
  }
}

int begin(const NewOptions& options) {
  if (!is_name(options.name))
    return refuse(false, exit_bad_input, "invalid_command_line",
                  fmt::format("\"{}\" is no name: small letters, digits and _, beginning with a letter, as in "
                              "spring_pendulum",
                              options.name));
  if (is_taken(class_name(options.name)))
    return refuse(false, exit_bad_input, "invalid_command_line",
                  fmt::format("{}: the library has a class {}; give another name, as in my_{}", options.name,
                              class_name(options.name), options.name));
  const fs::path folder = options.folder.empty() ? fs::path(options.name) : fs::path(options.folder);
  std::vector<std::pair<std::string, std::string>> files;
  std::string system = options.name;
  Offered on = *std::ranges::find(offered, options.groupoid, &Offered::name);
  const std::string own_file = options.name + ".hpp";
  const std::string own_header = "\"" + own_file + "\"";
  const std::string own_class = class_name(options.name);
  const std::string own_words = "the groupoid " + options.name;
  if (options.what == "groupoid") {
    system = "on_" + options.name;
    on = {options.name, own_header, own_class,
          own_words,    2,          "configuration = [0.0, 1.0, 0.0]    # p, q, s: at q\nmomentum = [0.0, 0.5]",
          true};
    files.emplace_back(own_file, filled(templates::groupoid(), {{"class", own_class}, {"name", options.name}}));
  }
  const Words words = words_of_system(system, on);
  const bool of_bracket = options.what == "bracket";
  files.emplace_back(system + ".cpp", filled(of_bracket ? templates::bracket() : templates::system(), words));
  files.emplace_back(system + ".toml", filled(of_bracket ? templates::bracket_scene() : templates::scene(), words));
  files.emplace_back("CMakeLists.txt", filled(templates::cmake(), words));
  write_folder(folder.has_parent_path() ? folder : fs::path(".") / folder, files);
  std::string report;
  for (const auto& [name, text] : files) report += fmt::format("  wrote {}\n", (folder / name).string());
  print(report + fmt::format("lagroid run {}\n", (folder / (system + ".cpp")).string()));
  return 0;
}

}  // namespace

ProgramCommand new_command() {
  const auto options = std::make_shared<NewOptions>();
  return {"new",
          [=](CLI::App& program) {
            CLI::App* command = program.add_subcommand(
                "new", "begin a system, a groupoid or a Poisson bracket of your own, in a folder");
            std::vector<std::string> names;
            for (const Offered& each : offered) names.emplace_back(each.name);
            const std::array<std::array<const char*, 2>, 3> kinds{{{"system", "a discrete Lagrangian"},
                                                                   {"groupoid", "a groupoid, and a system on it"},
                                                                   {"bracket", "a Poisson bracket with its energy"}}};
            for (const auto& [what, about] : kinds) {
              CLI::App* sub = command->add_subcommand(what, about);
              sub->add_option("name", options->name, "small letters, as in spring_pendulum")->required();
              sub->add_option("--out", options->folder, "the folder; its name otherwise");
              if (std::string(what) == "system")
                sub->add_option("--groupoid", options->groupoid,
                                "what it is on: " + fmt::format("{}", fmt::join(names, ", ")))
                    ->check(CLI::IsMember(names));
              sub->callback([options, kind = std::string(what)] { options->what = kind; });
            }
            command->require_subcommand(1);
            return command;
          },
          [=](SceneOptions&) { return begin(*options); }};
}

}  // namespace lagroid::app
