#pragma once
/// A Lagrangian or a Hamiltonian written as text, as a motion: it runs, is recorded, judged, studied and looked into as
/// any other.
///
///     FormulaMotion motion("pendulum", std::move(system), std::move(method), start, /*h*/ 0.01, /*t*/ 0);
///     motion.advance();
///
/// Requires a start on the constraints. Errors: those of the method's steps, as their status.

#include <lagroid/run/formula/formula_lagrangian.hpp>
#include <lagroid/run/motion/motion.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lagroid {

/// A step, and what it declares.
struct FormulaMethod {
  std::unique_ptr<SizedStep> step;
  MethodTraits traits;
};

/// What is to be seen of one. Fields: position, velocity, tangent momentum, energy, momenta of symmetries, drifts, and
/// with constraints the residual of these.
class FormulaNode final : public Observables {
 public:
  explicit FormulaNode(const FormulaSystem& system, bool symplectic);

  void see(long index, double time, const SizedState& state, const SizedStep& step);

  long index() const override { return index_; }
  double time() const override { return time_; }
  Endpoint endpoint() const override;
  bool finite() const override { return tangent_.found; }
  const std::vector<Field>& fields() const override { return fields_; }
  void read(std::size_t field, double* row) const override;
  const std::vector<Watched>& quantities() const override { return watched_; }
  double measure(std::size_t quantity, double* values) const override;
  Constrained constrained() const override {
    return system_.constraint_count() > 0 ? Constrained::promised : Constrained::no;
  }
  std::optional<double> residual() const override;
  double residual_size() const override { return residual_size_; }

 private:
  const FormulaSystem& system_;
  std::vector<Field> fields_;
  std::vector<Watched> watched_;
  long index_ = 0;
  double time_ = 0;
  SizedState state_;
  TangentState tangent_;
  std::size_t columns_;  ///< by which momenta of symmetries have slopes
  std::vector<double> momentum_slopes_;
  double residual_ = 0, residual_size_ = 1;
};

class FormulaMotion final : public Motion {
 public:
  /// The system is the motion's own, whose parameters events may set, and the method is of it.
  FormulaMotion(std::string name, std::unique_ptr<FormulaSystem> system, FormulaMethod method, SizedState start,
                double step, double begin);

  std::string name() const override { return name_; }
  MethodTraits traits() const override { return method_.traits; }
  StepReport advance() override;
  std::string failure(const StepReport& report, long step) const override;
  long index() const override { return index_; }
  double time() const override { return begin_ + double(index_) * size_; }
  double step_size() const override { return size_; }
  const Observables& look() override;
  std::vector<NamedVector> state() const override;
  std::optional<double> defect() const override;
  void describe(RunResult& result) const override;

  std::string why_not_cut() const override { return ""; }
  void keep_node() override;
  const Observables* look_within(double share) override;
  Changeable changeable() const override;
  std::string refused(double share, const MotionChange& change) override;
  StepReport change_within(double share, const MotionChange& change) override;
  void serialize(NumberArchive& archive) override;

 private:
  StepReport go_within(double share);
  /// Why a motion that is inside of its step cannot go on as that of another system; empty where it can.
  std::string refused_by(const FormulaSystem& after, double t) const;
  SizedState kicked(const MotionChange& change) const;

  std::string name_;
  std::unique_ptr<FormulaSystem> system_;
  FormulaMethod method_;
  SizedState state_;
  double size_, begin_;
  FormulaNode node_;
  long index_ = 0;
  SizedState kept_, inside_;
  double kept_time_ = 0;
  double rest_ = 1;  ///< of the step, from there on
};

}  // namespace lagroid
