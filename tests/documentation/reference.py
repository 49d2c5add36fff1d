"""The C++ reference has what is public of a header, as its docstrings stand."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from pages import root

sys.path.insert(0, str(root / "docs/site"))
import api

header = """#pragma once
/// Halves of things.
///
/// What is <halved> in \\R^n, phi(g) = 0 & more.

namespace lagroid {

namespace detail {
/// Nobody's business.
struct Hidden {};
}  // namespace detail

/// Things that have a half. With f = <lambda, phi>,
///     half(x) = x / 2
/// in `Vector<S, N>`.
template <class X>
concept Halved = requires(X x) { x / 2; };

/// A half.
template <Halved X, int N = 2> class Half : public X {
 public:
  /// The whole.
  template <class Y>
  requires Halved<Y>
  Y whole(const Y& y) const { return y; }
  double size = 1;

 private:
  double secret = 0;
};

void unsaid();

}  // namespace lagroid
"""


class Reference(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for each in ("core", "groupoids", "solvers", "systems", "run", "api"):
                (folder / each).mkdir()
            (folder / "docs").symlink_to(root / "docs")
            (folder / "core/half.hpp").write_text(header)
            done = subprocess.run(["doxygen", "docs/site/Doxyfile"], cwd=folder, capture_output=True, text=True,
                                  env={**os.environ, "LAGROID_API": str(folder / "api")})
            cls.warnings = done.stderr
            cls.about, entities = api.read_api(folder / "api/xml")
            cls.entities = {entity.name: entity for entity in entities["core/half.hpp"]}

    @staticmethod
    def words(said):
        return " ".join(" ".join(node.astext() for node in said).split())

    def test_takes_docstrings_as_they_stand(self):
        self.assertEqual(self.warnings, "")
        self.assertEqual(self.words(self.about["core/half.hpp"]),
                         "Halves of things. What is <halved> in \\R^n, phi(g) = 0 & more.")
        self.assertEqual(self.words(self.entities["Halved"].said),
                         "Things that have a half. With f = <lambda, phi>, half(x) = x / 2 in Vector<S, N>.")

    def test_has_what_is_public_and_nothing_else(self):
        self.assertEqual(set(self.entities), {"Halved", "Half", "unsaid"})
        self.assertEqual([member.name for member in self.entities["Half"].members], ["whole", "size"])
        self.assertEqual(self.entities["unsaid"].said, [])  # and so is not shown

    def test_writes_declarations_as_we_do(self):
        self.assertEqual(self.entities["Half"].declaration, "template <Halved X, int N = 2> class Half : X")
        whole, size = self.entities["Half"].members
        self.assertEqual(whole.declaration, "template <class Y> requires Halved<Y> Y whole(const Y& y) const")
        self.assertEqual(size.declaration, "double size = 1")
        self.assertTrue(self.entities["Halved"].declaration.startswith("template <class X>\nconcept Halved = requires"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
