#include <lagroid/run/ledger/judge.hpp>

#include <algorithm>

namespace lagroid {

Judge::Judge(const Observables& node) : constrained_(node.constrained()), quantities_(node.quantities()) {
  for (const Watched& q : quantities_) {
    watches_.emplace_back(q.name, q.promise, q.components.size(), q.size_of);
    values_.emplace_back(q.components.size());
  }
}

void Judge::observe(const Observables& node) {
  positions_.observe([&] { return node.positions(); });
  const double noise = node.noise();
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    if (quantities_[i].on_arrows && node.index() == 0) continue;
    if (!node.quantities()[i].is_promised) quantities_[i].is_promised = false;
    double size = node.measure(i, values_[i].data());
    if (quantities_[i].size_of == SizeOf::value) size = norm_of(values_[i]);
    watches_[i].observe(values_[i].data(), size, noise * size);
  }
  if (constrained_ == Constrained::no) return;
  const std::optional<double> residual = node.residual();
  // The size of the constraints' terms changes slowly: looked at where a residual stands out.
  if (residual && (!(*residual <= largest_residual_) || residual_size_ == 0)) {
    residual_size_ = std::max(residual_size_, node.residual_size());
    largest_residual_ = worse(largest_residual_, *residual);
  }
}

void Judge::report(Ledger& ledger) const {
  if (constrained_ != Constrained::no) {
    LedgerEntry entry = constraint_entry(largest_residual_, residual_size_);
    ledger.entries.push_back(constrained_ == Constrained::promised ? std::move(entry) : unpromised(std::move(entry)));
  }
  for (std::size_t i = 0; i < watches_.size(); ++i)
    ledger.entries.push_back(quantities_[i].is_promised ? watches_[i].entry() : unpromised(watches_[i].entry()));
  positions_.withhold_verdicts(ledger);
}

}  // namespace lagroid
