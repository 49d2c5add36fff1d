#pragma once
/// The certificates of the library's systems, compiled once (target lagroid_certificates): `laws::certificate`,
/// declared without the suites' headers. For a system of your own include solvers/testing/certificate.hpp instead.

#include <lagroid/core/system.hpp>
#include <lagroid/core/testing/law_report.hpp>

#include <functional>
#include <string_view>
#include <vector>

namespace lagroid::laws {

/// Every law that applies, tested on one system (solvers/testing/certificate.hpp; include that for a system of your
/// own).
template <DiscreteSystem Sys>
std::vector<LawReport> certificate(const Sys& system, const std::function<State<typename Sys::GroupoidType>()>& draw);
/// Those of its groupoid alone, which take no step (solvers/testing/certificate.hpp).
template <DiscreteSystem Sys>
std::vector<LawReport> groupoid_certificate(const Sys& system,
                                            const std::function<State<typename Sys::GroupoidType>()>& draw);
/// The laws of the system that it is reduced to by the reduction of that name
/// (solvers/testing/reduced_certificate.hpp).
template <DiscreteSystem Sys>
std::vector<LawReport> reduced_certificate(const Sys& system, std::string_view name,
                                           const std::function<State<typename Sys::GroupoidType>()>& draw);

}  // namespace lagroid::laws
