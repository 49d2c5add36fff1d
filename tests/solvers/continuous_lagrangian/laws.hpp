#pragma once
/// The library's own suites on discretised Lagrangians.

#include <lagroid/solvers/testing/certificate.hpp>

#include "subjects.hpp"

namespace lagroid::subjects {

template <class Sys, class Draw> void expect_laws(const Sys& system, const Draw& draw) {
  for (const laws::LawReport& report : laws::system_laws<Sys>(system, draw)) EXPECT_TRUE(report.holds()) << report;
}

}  // namespace lagroid::subjects
