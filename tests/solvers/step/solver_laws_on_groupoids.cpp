// Two thousand steps by Ceres of a motion on every groupoid of the library.
#include <lagroid/groupoids/action.hpp>
#include <lagroid/groupoids/groups/linear.hpp>
#include <lagroid/groupoids/groups/orthogonal.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/groups/translations.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/pair_of.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/groupoids/trivial.hpp>
#include <lagroid/solvers/step/ceres_step.hpp>
#include <lagroid/solvers/testing/solver_laws.hpp>

#include "groupoid_motion.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <tuple>

using namespace lagroid;
