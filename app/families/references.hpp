#pragma once
/// The papers behind the program: the one place where they stand. CITATION.cff is written from here.

#include <lagroid/solvers/methods/sources.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

struct Author {
  std::string_view given;
  std::string_view family;
};

/// An article in a journal.
struct Article {
  std::string_view key;     ///< of BibTeX, and in --json
  std::string_view letter;  ///< [G], [N], [V] and [H] of this project's documentation; empty for the others
  std::vector<Author> authors;
  std::string_view title;
  std::string_view journal;
  int volume = 0;
  int number = 0;  ///< of the issue; 0: the journal counts none
  std::string_view first_page;
  std::string_view last_page;  ///< empty: `first_page` is the number of the article
  int year = 0;
  std::string_view doi;
  std::string_view arxiv;  ///< empty where there is none
};

/// All of them, [G], [N], [V] and [H] first.
std::span<const Article> references();
/// The one with that key, which is one of them.
const Article& reference(std::string_view key);

/// A reference, and what it stands behind.
struct Use {
  const Article* reference;
  std::string what;
};

/// Adds what a method or a system names as its source, if it names one.
void add_use(const Source& source, std::vector<Use>& uses);

}  // namespace lagroid::app
