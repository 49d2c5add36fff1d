#pragma once
/// What a check of laws found, in words and as JSON.
///
///     std::cout << text_certificate(certificate);
///     return certificate.holds() ? 0 : 1;

#include <lagroid/core/testing/law_report.hpp>

#include <string>
#include <vector>

namespace lagroid {

/// A declared symmetry and what it turned out to be along a run.
struct SymmetryFinding {
  std::string name;
  std::string kind;
  double defect = 0;
  bool holds = false;
};

/// A declared reduction and whether the system descends along it.
struct ReductionFinding {
  std::string name;
  std::string groupoid;     ///< of the reduced system
  double defect = 0;        ///< the largest of all that is to be invariant, relative
  std::string why_not;      ///< empty where it descends
  bool is_claimed = false;  ///< by the scene: what is then none is broken
  bool holds() const { return why_not.empty() || !is_claimed; }
};

struct Certificate {
  std::string system;
  std::string groupoid;
  std::string failure;  ///< why the run that laws are tested along ended early: then those of a groupoid alone are
  std::string failure_status;  ///< as in RunResult
  std::size_t states = 0;      ///< of that run, from which samples were drawn; 0: they were drawn by the caller
  int samples = 0;             ///< of each law
  long seed = 0;
  double seconds = 0;
  std::vector<laws::LawReport> suites;
  std::vector<SymmetryFinding> symmetries;
  std::vector<ReductionFinding> reductions;

  bool holds() const;
  std::string status() const { return holds() ? "certified" : failure.empty() ? "broken" : failure_status; }
};

std::string text_certificate(const Certificate& certificate);

/// One JSON object. Keys: docs/scenes.md.
std::string json_certificate(const Certificate& certificate);

}  // namespace lagroid
