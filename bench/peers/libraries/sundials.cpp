// SUNDIALS: CVODE and ARKODE's ERKStep, as their user guides advise for problems that are not stiff. CVODE: Adams
// methods with the fixed-point solver. ERKStep: its default tables of orders 4, 5 and 8. The tolerance is both absolute
// and relative. For problems bound to a submanifold also with projection: of CVODE's methods the BDF alone take it
// (CVodeSetProjFn), with Newton's method; ERKStep after every step (ERKStepSetPostprocessStepFn).
#include "libraries.hpp"

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#include <cvode/cvode_proj.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <memory>
#include <stdexcept>
#include <utility>

namespace peers {

namespace {

template <class P> using State = std::array<double, P::unknowns>;

template <class P> State<P>& numbers(N_Vector v) { return *reinterpret_cast<State<P>*>(N_VGetArrayPointer_Serial(v)); }

template <class P> int right_hand_side(double, N_Vector y, N_Vector dy, void* problem) {
  (*static_cast<const P*>(problem))(numbers<P>(y), numbers<P>(dy));
  return 0;
}

template <class P> int projection(double, N_Vector y, N_Vector correction, double, N_Vector error, void* problem) {
  State<P> projected = numbers<P>(y);
  static_cast<const P*>(problem)->project(projected);
  for (std::size_t i = 0; i < projected.size(); ++i) numbers<P>(correction)[i] = projected[i] - numbers<P>(y)[i];
  // The error estimate keeps what is tangent to the submanifold.
  if (error != nullptr) {
    State<P> moved = numbers<P>(y);
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += numbers<P>(error)[i];
    static_cast<const P*>(problem)->project(moved);
    for (std::size_t i = 0; i < moved.size(); ++i) numbers<P>(error)[i] = moved[i] - projected[i];
  }
  return 0;
}

template <class P> int project_step(double, N_Vector y, void* problem) {
  static_cast<const P*>(problem)->project(numbers<P>(y));
  return 0;
}

void require(int flag, const char* what) {
  if (flag != 0) throw std::runtime_error(what);
}

/// What an integration needs, freed in the reverse order.
template <class P> struct Session {
  explicit Session(const P& problem_) : problem(problem_) {
    require(SUNContext_Create(nullptr, &context), "SUNContext_Create");
    y = N_VNew_Serial(P::unknowns, context);
    numbers<P>(y) = problem.start();
  }
  ~Session() {
    if (cvode != nullptr) CVodeFree(&cvode);
    if (erk != nullptr) ERKStepFree(&erk);
    if (iteration != nullptr) SUNNonlinSolFree(iteration);
    if (elimination != nullptr) SUNLinSolFree(elimination);
    if (matrix != nullptr) SUNMatDestroy(matrix);
    N_VDestroy(y);
    SUNContext_Free(&context);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  P problem;
  SUNContext context = nullptr;
  N_Vector y = nullptr;
  void* cvode = nullptr;
  void* erk = nullptr;
  SUNNonlinearSolver iteration = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver elimination = nullptr;
};

template <class P> void begin_cvode(Session<P>& session, int family, bool projected, double end, double tolerance) {
  session.cvode = CVodeCreate(family, session.context);
  CVodeSetErrFile(session.cvode, nullptr);
  require(CVodeInit(session.cvode, right_hand_side<P>, 0, session.y), "CVodeInit");
  require(CVodeSetUserData(session.cvode, &session.problem), "CVodeSetUserData");
  require(CVodeSStolerances(session.cvode, tolerance, tolerance), "CVodeSStolerances");
  require(CVodeSetMaxNumSteps(session.cvode, -1), "CVodeSetMaxNumSteps");
  require(CVodeSetStopTime(session.cvode, end), "CVodeSetStopTime");
  if (family == CV_ADAMS) {
    session.iteration = SUNNonlinSol_FixedPoint(session.y, 0, session.context);
    require(CVodeSetNonlinearSolver(session.cvode, session.iteration), "CVodeSetNonlinearSolver");
  } else {
    session.matrix = SUNDenseMatrix(P::unknowns, P::unknowns, session.context);
    session.elimination = SUNLinSol_Dense(session.y, session.matrix, session.context);
    require(CVodeSetLinearSolver(session.cvode, session.elimination, session.matrix), "CVodeSetLinearSolver");
  }
  if constexpr (requires(State<P> y) { session.problem.project(y); })
    if (projected) require(CVodeSetProjFn(session.cvode, projection<P>), "CVodeSetProjFn");
}

template <class P> void begin_erk(Session<P>& session, int order, bool projected, double end, double tolerance) {
  session.erk = ERKStepCreate(right_hand_side<P>, 0, session.y, session.context);
  ERKStepSetErrFile(session.erk, nullptr);
  require(ERKStepSetUserData(session.erk, &session.problem), "ERKStepSetUserData");
  require(ERKStepSetOrder(session.erk, order), "ERKStepSetOrder");
  require(ERKStepSStolerances(session.erk, tolerance, tolerance), "ERKStepSStolerances");
  require(ERKStepSetMaxNumSteps(session.erk, -1), "ERKStepSetMaxNumSteps");
  require(ERKStepSetStopTime(session.erk, end), "ERKStepSetStopTime");
  if constexpr (requires(State<P> y) { session.problem.project(y); })
    if (projected) require(ERKStepSetPostprocessStepFn(session.erk, project_step<P>), "ERKStepSetPostprocessStepFn");
}

template <class P> Outcome run(Session<P>& session, double end) {
  const auto coordinates = [&] { return session.problem.coordinates(numbers<P>(session.y)); };
  Watch<P> watch(session.problem);
  double t = 0;
  while (t < end) {
    const int flag = session.cvode != nullptr ? CVode(session.cvode, end, session.y, &t, CV_ONE_STEP)
                                              : ERKStepEvolve(session.erk, end, session.y, &t, ARK_ONE_STEP);
    if (flag < 0) {
      char* name = session.cvode != nullptr ? CVodeGetReturnFlagName(flag) : ERKStepGetReturnFlagName(flag);
      std::string why = name;
      std::free(name);
      return watch.fail(coordinates(), std::move(why));
    }
    watch.step(coordinates);
  }
  return watch.finish(coordinates());
}

template <class P, class Begin> Method method(const P& problem, std::string name, const Begin& begin) {
  return {"SUNDIALS", std::move(name), true, 1e-2, std::sqrt(10.0), [=](double end, double tolerance) -> Task {
            const auto session = std::make_shared<Session<P>>(problem);
            begin(*session, end, tolerance);
            return [session, end] { return run(*session, end); };
          }};
}

}  // namespace

template <class P> Methods sundials_methods(const P& problem) {
  Methods out;
  out.push_back(method(problem, "CVODE Adams", [](Session<P>& session, double end, double tolerance) {
    begin_cvode(session, CV_ADAMS, false, end, tolerance);
  }));
  constexpr bool bound = requires(State<P> y) { problem.project(y); };
  for (const bool projected : {false, true}) {
    if (projected && !bound) continue;
    if (projected)
      out.push_back(method(problem, "CVODE BDF, projected", [](Session<P>& session, double end, double tolerance) {
        begin_cvode(session, CV_BDF, true, end, tolerance);
      }));
    for (const int order : {4, 5, 8})
      out.push_back(method(problem, "ARKODE ERK " + std::to_string(order) + (projected ? ", projected" : ""),
                           [order, projected](Session<P>& session, double end, double tolerance) {
                             begin_erk(session, order, projected, end, tolerance);
                           }));
  }
  return out;
}

template Methods sundials_methods(const RigidBodyProblem&);
template Methods sundials_methods(const KeplerProblem&);
template Methods sundials_methods(const PendulumProblem&);
template Methods sundials_methods(const SphericalPendulumProblem&);
template Methods sundials_methods(const TopProblem&);
template Methods sundials_methods(const ChainProblem&);

std::string sundials_version() { return std::string("SUNDIALS ") + SUNDIALS_VERSION; }

}  // namespace peers
