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

struct Certificate {
  std::string system;
  std::string groupoid;
  std::string failure;         ///< why the run that laws are tested along ended early, if it did: then none was tested
  std::string failure_status;  ///< as in RunResult
  std::size_t states = 0;      ///< of that run, from which samples were drawn; 0: they were drawn by the caller
  int samples = 0;             ///< of each law
  long seed = 0;
  double seconds = 0;
  std::vector<laws::LawReport> suites;
  std::vector<SymmetryFinding> symmetries;

  bool holds() const;
  std::string status() const { return holds() ? "certified" : failure.empty() ? "broken" : failure_status; }
};

std::string text_certificate(const Certificate& certificate);

/// One JSON object. Keys: docs/scenes.md.
std::string json_certificate(const Certificate& certificate);

}  // namespace lagroid
