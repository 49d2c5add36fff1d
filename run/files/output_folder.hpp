#pragma once
/// A folder of output files: of one kind, of one scene, written by one process at a time, each file whole or not at
/// all.
///
/// A command can then never overwrite something that it did not make, nor leave half of a file.
///
///     const char* const files[] = {"table.csv"};
///     const OutputFolder held("out/table", OutputKind::report, OutputSource{{"scene", scene}}, files);
///     write_text(table, "out/table/table.csv");
///
/// Errors: FolderRefused where the folder is no place for the files, with the remedy in one line; OutputError where the
/// disk is full.

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lagroid {

/// Something that a command puts out cannot be written.
class OutputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A folder that is no place for what a command puts out. The message is one line with the remedy.
class FolderRefused : public OutputError {
  using OutputError::OutputError;
};

/// A folder that holds no run, or one that cannot be shown or taken up. The message is one line with the remedy.
class RunError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a folder holds. Data (`lagroid trajectories`) lie in folders of the user's own, which they leave unmarked.
enum class OutputKind { run, sweep, study, optimum, model, report, data };

/// What the contents of a folder were made of: names ("scene", "data", ...) and texts. Where one differs, so may
/// the results, and the message names the first that does.
using OutputSource = std::vector<std::pair<std::string, std::string>>;

/// A folder that this process alone writes in as long as this lives. A file `.lagroid` in it records what it holds
/// and of what source, so that nothing is written over anything else; a folder without one is judged by its files.
class OutputFolder {
 public:
  /// Makes the folder where it is missing. Without a `source` it takes the folder as it is: to go on there, to draw
  /// anew. `files` are all that the command may write. Throws FolderRefused, naming what is there and the remedy: where
  /// the folder is no folder, nothing can be written in it, another process is at work there, or it holds another kind
  /// or the same of another source. Throws OutputError where the disk is full.
  OutputFolder(std::filesystem::path folder, OutputKind kind, const std::optional<OutputSource>& source,
               std::span<const char* const> files);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  /// Where nothing was left, the folder is as before.
  ~OutputFolder();

  /// Whether an earlier command left its mark there.
  bool known() const { return known_; }
  /// Of a folder whose contents turn out to be somebody else's: it is left without the mark that this made.
  void disown();

 private:
  void lock();
  void leave();
  void refuse_others(const std::optional<OutputSource>& source);

  std::filesystem::path folder_;
  OutputKind kind_;
  std::vector<std::filesystem::path> made_;  ///< folders, the innermost first
  int lock_ = -1;
  bool known_ = false;
  bool ours_ = false;  ///< the mark was made by this
};

/// Throws FolderRefused, with the remedy, unless `folder` can be created and `files` be written there. Leaves nothing
/// behind.
void require_writable(const std::filesystem::path& folder, std::span<const char* const> files);

/// Writes files into the folder it is given; returns their names.
using FileWriter = std::function<std::vector<std::string>(const std::filesystem::path&)>;

/// What `make` writes is renamed into `folder`, so that each file is there whole or not at all. Those of `files`, all
/// that the command can make, that were not made this time are removed, and what killed processes left half-written.
/// Returns the files written. Throws OutputError.
std::vector<std::filesystem::path> write_whole(const std::filesystem::path& folder, std::span<const char* const> files,
                                               const FileWriter& make);

/// What gnuplot makes of a script.
struct Drawing {
  std::string script;  ///< empty: nothing is drawn
  std::vector<std::string> pictures;
};

/// Runs gnuplot on a script of `folder` beside the files that are there, and puts all pictures into the folder, or
/// none. A signal that an InterruptGuard notes ends it at once, unless one came before, which ended what is to be
/// drawn. Empty, or the reason why there are no pictures.
std::string draw(const std::filesystem::path& folder, const Drawing& drawing, bool interrupted_before);

/// `write_whole`, and when all that is there, `draw`: a signal that comes meanwhile ends the drawing. `note` gets the
/// reason where there are no pictures. `tell` writes the files that name pictures: with the other files, as if there
/// were none, and again when they are drawn.
std::vector<std::filesystem::path> write_and_draw(
    const std::filesystem::path& folder, std::span<const char* const> files, const FileWriter& make,
    const Drawing& drawing, std::string& note,
    const std::function<std::vector<std::string>(const std::filesystem::path&, bool drawn)>& tell = nullptr);

/// Throws OutputError where the disk is full.
void write_text(std::string_view text, const std::filesystem::path& file);

}  // namespace lagroid
