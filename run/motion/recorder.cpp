#include <lagroid/run/motion/recorder.hpp>

#include <cstddef>
#include <numeric>
#include <vector>

namespace lagroid {

namespace {

/// Of the two unit quaternions of a rotation, the one nearer to the row before, so that curves have no jumps.
void choose_sign(std::vector<double>& rows) {
  constexpr std::ptrdiff_t width = 4;
  if (rows.size() < 2 * width) return;
  const auto last = rows.end() - width;
  if (std::inner_product(last, rows.end(), last - width, 0.0) < 0)
    for (auto component = last; component != rows.end(); ++component) *component = -*component;
}

}  // namespace

Recorder::Recorder(const Observables& node) {
  for (const Field& field : node.fields()) trajectory_.series.push_back(field.columns);
}

void Recorder::record(const Observables& node, const Judge* judge) {
  trajectory_.time.push_back(node.time());
  const bool is_first = trajectory_.time.size() == 1;
  const std::vector<Field>& fields = node.fields();
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Field& field = fields[i];
    if (field.columns.on_arrows && is_first) continue;
    std::vector<double>& rows = trajectory_.series[i].values;
    if (field.drift_of) {
      rows.push_back(judge->drift(*field.drift_of));
      continue;
    }
    const std::size_t at = rows.size();
    rows.resize(at + field.columns.width());
    node.read(i, rows.data() + at);
    if (field.is_unit_quaternion) choose_sign(rows);
  }
}

}  // namespace lagroid
