// Two thousand steps by Ceres of a motion on every groupoid of the library.
#include <lagroid/groupoids/action.hpp>
#include <lagroid/groupoids/linear.hpp>
#include <lagroid/groupoids/orthogonal.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/pair_of.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/groupoids/se2.hpp>
#include <lagroid/groupoids/se3.hpp>
#include <lagroid/groupoids/so2.hpp>
#include <lagroid/groupoids/so3.hpp>
#include <lagroid/groupoids/translations.hpp>
#include <lagroid/groupoids/trivial.hpp>
#include <lagroid/groupoids/vector_group.hpp>
#include <lagroid/solvers/ceres_step.hpp>
#include <lagroid/solvers/testing/solver_laws.hpp>

#include "groupoid_motion.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <tuple>

using namespace lagroid;
