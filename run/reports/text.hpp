#pragma once
/// Which text may stand in a scene, and how text that anyone may have written is shown.

#include <cstddef>
#include <string>
#include <string_view>

namespace lagroid {

/// Bytes: those of a path.
inline constexpr std::size_t longest_text = 4096;

/// Why a name, a label or a path of a scene is refused; empty where it is not. It is of one line, in UTF-8 and not
/// longer than `longest_text`: without control characters (U+0000 to U+001F, U+007F to U+009F), which a terminal obeys
/// and which end a line of a script, without U+2028 and U+2029, and without those that turn the direction of writing,
/// which show another text than is there.
std::string text_problem(std::string_view text);

/// The same of a key: letters of ASCII, digits, - and _, as TOML has them without quotes.
std::string key_problem(std::string_view key);

/// The text with every character that `text_problem` refuses, but for those of `kept`, written as \u001b; bytes that
/// are not UTF-8 become U+FFFD. In a string of JSON it means the same as before.
std::string visible(std::string_view text, std::string_view kept = "");

}  // namespace lagroid
