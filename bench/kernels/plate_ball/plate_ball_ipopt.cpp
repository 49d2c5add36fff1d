#include "plate_ball_ipopt.hpp"

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace kernels {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Ipopt::Index;
using Ipopt::Number;

/// s_a = p^T B_a q for s = conj(p) q, quaternions as (w, x, y, z).
const std::array<Matrix4d, 4>& product_forms() {
  static const std::array<Matrix4d, 4> forms = [] {
    std::array<Matrix4d, 4> b;
    b[0].setIdentity();
    b[1] << 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0;
    b[2] << 0, 0, 1, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, -1, 0, 0;
    b[3] << 0, 0, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0, -1, 0, 0, 0;
    return b;
  }();
  return forms;
}

struct Node {
  Vector2d position;
  Vector4d quaternion;
};

/// Node k = 1 ... N - 1 holds the variables 6 (k - 1) ... 6 (k - 1) + 5; step k = 0 ... N - 1 joins nodes k and k + 1
/// and holds the constraints 3 k, 3 k + 1, 3 k + 2; the constraint of node k's norm is 3 N + k - 1.
class Program final : public Ipopt::TNLP {
 public:
  Program(const PlateBallParameters& parameters, const PlateBallPath& start, IpoptSolution& solution)
      : parameters_(parameters), solution_(solution), steps_(Index(start.multipliers.size())) {
    Vector4d last(1, 0, 0, 0);
    for (std::size_t k = 0; k < start.position.size(); ++k) {
      const Eigen::Quaterniond q(start.attitude[k]);
      Vector4d next(q.w(), q.x(), q.y(), q.z());
      if (next.dot(last) < 0) next = -next;
      start_.push_back({start.position[k], next});
      last = next;
    }
  }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = 6 * (steps_ - 1);
    m = 3 * steps_ + steps_ - 1;
    jacobian = (16 + 16 + 4) * (steps_ - 1);
    hessian = 12 * (steps_ - 1) + 18 * (steps_ - 2);
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* lower, Number* upper, Index m, Number* low, Number* high) override {
    constexpr double infinity = 2e19;  // IPOPT's
    std::fill(lower, lower + n, -infinity);
    std::fill(upper, upper + n, infinity);
    std::fill(low, low + m, 0.0);
    std::fill(high, high + m, 0.0);
    return true;
  }

  bool get_starting_point(Index, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    for (Index k = 1; k < steps_; ++k) {
      Eigen::Map<Vector2d>(x + 6 * (k - 1)) = start_[std::size_t(k)].position;
      Eigen::Map<Vector4d>(x + 6 * (k - 1) + 2) = start_[std::size_t(k)].quaternion;
    }
    return true;
  }

  bool eval_f(Index, const Number* x, bool, Number& value) override {
    value = 0;
    for (Index k = 0; k < steps_; ++k) value += (node(x, k + 1).position - node(x, k).position).squaredNorm();
    value *= 0.5 / parameters_.h;
    return true;
  }

  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    std::fill(gradient, gradient + n, 0.0);
    for (Index k = 1; k < steps_; ++k)
      Eigen::Map<Vector2d>(gradient + 6 * (k - 1)) =
          (2 * node(x, k).position - node(x, k - 1).position - node(x, k + 1).position) / parameters_.h;
    return true;
  }

  bool eval_g(Index, const Number* x, bool, Index, Number* out) override {
    const auto& [h, radius, rate, spin] = parameters_;
    const double b = 0.5 * h * rate;
    for (Index k = 0; k < steps_; ++k) {
      const Node from = node(x, k);
      const Node to = node(x, k + 1);
      const Vector2d d = to.position - from.position;
      const Vector2d sum = to.position + from.position;
      const Vector4d s = product(from.quaternion, to.quaternion);
      const Vector3d w = 2 * s(0) * s.tail<3>();
      Eigen::Map<Vector3d>(out + 3 * k) << d(1) + radius * w(0) - b * sum(0), d(0) - radius * w(1) + b * sum(1),
          h * spin - w(2);
    }
    for (Index k = 1; k < steps_; ++k) out[3 * steps_ + k - 1] = node(x, k).quaternion.squaredNorm() - 1;
    return true;
  }

  /// Entries in the order: for each step its dependence on its first node, then on its second; then the norms.
  bool eval_jac_g(Index, const Number* x, bool, Index, Index, Index* row, Index* column, Number* value) override {
    const double b = 0.5 * parameters_.h * parameters_.plate_rate;
    Index at = 0;
    const auto put = [&](Index i, Index j, double entry) {
      if (value != nullptr) {
        value[at] = entry;
      } else {
        row[at] = i;
        column[at] = j;
      }
      ++at;
    };
    for (Index k = 0; k < steps_; ++k) {
      for (const bool second : {false, true}) {
        const Index n = second ? k + 1 : k;
        if (n == 0 || n == steps_) continue;
        const double sign = second ? 1 : -1;
        const Index start = 6 * (n - 1);
        Eigen::Matrix<double, 3, 4> turning = Eigen::Matrix<double, 3, 4>::Zero();
        if (value != nullptr) turning = rotation_gradient(node(x, k).quaternion, node(x, k + 1).quaternion, second);
        put(3 * k, start, -b);
        put(3 * k, start + 1, sign);
        put(3 * k + 1, start, sign);
        put(3 * k + 1, start + 1, b);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 4; ++j) put(3 * k + i, start + 2 + j, weight(i) * turning(i, j));
      }
    }
    for (Index k = 1; k < steps_; ++k)
      for (int j = 0; j < 4; ++j)
        put(3 * steps_ + k - 1, 6 * (k - 1) + 2 + j, value == nullptr ? 0 : 2 * node(x, k).quaternion(j));
    return true;
  }

  /// Lower triangle, node by node: the block of the node, then the block that joins it to the next one.
  bool eval_h(Index, const Number* x, bool, Number factor, Index, const Number* multipliers, bool, Index, Index* row,
              Index* column, Number* value) override {
    Index at = 0;
    const auto put = [&](Index i, Index j, double entry) {
      if (value != nullptr) {
        value[at] = entry;
      } else {
        row[at] = i;
        column[at] = j;
      }
      ++at;
    };
    const double stiffness = factor / parameters_.h;
    Curvature before;
    if (value != nullptr) before = curvature(x, 0, multipliers);
    for (Index k = 1; k < steps_; ++k) {
      const Index start = 6 * (k - 1);
      Curvature after;
      Matrix4d own = Matrix4d::Zero();
      if (value != nullptr) {
        after = curvature(x, k, multipliers);
        own = before.second + after.first + 2 * multipliers[3 * steps_ + k - 1] * Matrix4d::Identity();
      }
      put(start, start, 2 * stiffness);
      put(start + 1, start + 1, 2 * stiffness);
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j <= i; ++j) put(start + 2 + i, start + 2 + j, own(i, j));
      if (k + 1 < steps_) {
        put(start + 6, start, -stiffness);
        put(start + 7, start + 1, -stiffness);
        for (int i = 0; i < 4; ++i)
          for (int j = 0; j < 4; ++j) put(start + 8 + i, start + 2 + j, after.joint(j, i));
      }
      before = after;
    }
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number*, const Number*, Index,
                         const Number*, const Number* multipliers, Number cost, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    solution_.cost = cost;
    for (Index k = 0; k <= steps_; ++k) {
      const Node n = node(x, k);
      const Vector4d& q = n.quaternion;
      solution_.path.position.push_back(n.position);
      solution_.path.attitude.push_back(Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix());
      if (k < steps_) solution_.path.multipliers.emplace_back(Eigen::Map<const Vector3d>(multipliers + 3 * k));
    }
  }

 private:
  /// Second derivatives of the constraints of one step, times their multipliers, in the quaternions (p, q) of its ends.
  struct Curvature {
    Matrix4d first = Matrix4d::Zero();   // p p
    Matrix4d second = Matrix4d::Zero();  // q q
    Matrix4d joint = Matrix4d::Zero();   // p q
  };

  Node node(const Number* x, Index k) const {
    if (k == 0 || k == steps_) return start_[std::size_t(k)];
    return {Eigen::Map<const Vector2d>(x + 6 * (k - 1)), Eigen::Map<const Vector4d>(x + 6 * (k - 1) + 2)};
  }

  static Vector4d product(const Vector4d& p, const Vector4d& q) {
    Vector4d s;
    for (int a = 0; a < 4; ++a) s(a) = p.dot(product_forms()[std::size_t(a)] * q);
    return s;
  }

  /// The coefficient of w_i in constraint i.
  double weight(int i) const { return i == 0 ? parameters_.radius : i == 1 ? -parameters_.radius : -1; }

  /// dw / dp or dw / dq.
  static Eigen::Matrix<double, 3, 4> rotation_gradient(const Vector4d& p, const Vector4d& q, bool second) {
    const auto& forms = product_forms();
    const Vector4d s = product(p, q);
    const Vector4d& other = second ? p : q;
    Eigen::Matrix<double, 3, 4> out;
    for (int i = 0; i < 3; ++i) {
      const Matrix4d& form = forms[std::size_t(i + 1)];
      const Vector4d slope = second ? Vector4d(form.transpose() * p) : Vector4d(form * q);
      out.row(i) = 2 * (s(i + 1) * other + s(0) * slope).transpose();
    }
    return out;
  }

  /// Of 2 s0 t, with t = p^T B q and B the weighted sum of the forms.
  Curvature curvature(const Number* x, Index k, const Number* multipliers) const {
    const Vector4d p = node(x, k).quaternion;
    const Vector4d q = node(x, k + 1).quaternion;
    Matrix4d b = Matrix4d::Zero();
    for (int i = 0; i < 3; ++i) b += weight(i) * multipliers[3 * k + i] * product_forms()[std::size_t(i + 1)];
    const Vector4d by_p = b * q;
    const Vector4d by_q = b.transpose() * p;
    Curvature c;
    c.first = 2 * (q * by_p.transpose() + by_p * q.transpose());
    c.second = 2 * (p * by_q.transpose() + by_q * p.transpose());
    c.joint = 2 * (q * by_q.transpose() + by_p * p.transpose() + p.dot(by_p) * Matrix4d::Identity() + p.dot(q) * b);
    return c;
  }

  PlateBallParameters parameters_;
  IpoptSolution& solution_;
  Index steps_;
  std::vector<Node> start_;
};

}  // namespace

IpoptSolution solve_with_ipopt(const PlateBallParameters& parameters, const PlateBallPath& start, double tolerance) {
  IpoptSolution solution;
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication;
  application->Options()->SetIntegerValue("print_level", 0);
  application->Options()->SetStringValue("sb", "yes");
  application->Options()->SetNumericValue("tol", tolerance);
  application->Options()->SetStringValue("linear_solver", "mumps");
  if (application->Initialize() != Ipopt::Solve_Succeeded) throw std::runtime_error("IPOPT cannot be initialised");
  const Ipopt::SmartPtr<Ipopt::TNLP> program = new Program(parameters, start, solution);
  solution.solved = application->OptimizeTNLP(program) == Ipopt::Solve_Succeeded;
  solution.iterations = int(application->Statistics()->IterationCount());
  return solution;
}

}  // namespace kernels
