#pragma once
/// The papers that methods are from, by the keys that `lagroid cite` knows.
///
///     const Source source = source_of(compositions::kahan_li_8);  // source.key, source.what; empty for classical ones

#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/solvers/lie_group/method.hpp>

#include <string_view>

namespace lagroid {

/// A paper, by its key among those that `lagroid cite` knows, and what it stands behind; empty where there is none.
struct Source {
  std::string_view key;
  std::string_view what;
};

/// That of the coefficients. A step of its own has none, nor has a composition of the caller's.
Source source_of(const Composition& composition);
/// That of the method; classical ones in coordinates have none.
Source source_of(const LieGroupMethod& method);

}  // namespace lagroid
