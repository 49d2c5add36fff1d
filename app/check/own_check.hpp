#pragma once
/// `check` of a program of one's own (own_program.hpp).

#include "../own/own_parts.hpp"
#include "check_options.hpp"

#include <lagroid/run/ledger/certificate.hpp>

#include <functional>

namespace lagroid::app {

/// Tests the laws of the system of a module, along the run of a scene.
using AskLaws =
    std::function<Certificate(const SystemModule& module, const Section& scene, const CheckCommandOptions& options)>;

/// Serves a command line of `check` for the systems. Returns the exit code.
int own_check_program(int argc, char** argv, OwnSystems systems, AskLaws ask);

}  // namespace lagroid::app
