// The same run differentiated by ADOL-C, through Newton's iterations.
#include "methods.hpp"
#include "step.hpp"

#include <adolc/adolc.h>

namespace peers {

namespace {

constexpr short tag = 1;

void tape(const Start& start, long steps, double h, int outputs) {
  // Buffers that hold all of it: otherwise the tape goes to files.
  const unsigned int size = unsigned(steps) * 4000u + 100000u;
  trace_on(tag, 0, size, size, size / 4, size / 4);
  KeplerRun<adouble> run;
  run.q[0] <<= start.x[0];
  run.q[1] <<= start.x[1];
  run.p[0] <<= start.x[2];
  run.p[1] <<= start.x[3];
  run.k <<= start.x[4];
  run.go(steps, h);
  double out = 0;
  run.q[0] >>= out;
  if (outputs > 1) {
    run.q[1] >>= out;
    run.p[0] >>= out;
    run.p[1] >>= out;
  }
  trace_off();
}

}  // namespace

Matrix adolc_matrix(const Start& start, long steps, double h) {
  tape(start, steps, h, 4);
  double rows[4][5];
  double* at[4] = {rows[0], rows[1], rows[2], rows[3]};
  ::jacobian(tag, 4, 5, start.x.data(), at);
  Matrix out;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 5; ++j) out(i, j) = rows[i][j];
  return out;
}

Row adolc_gradient(const Start& start, long steps, double h) {
  tape(start, steps, h, 1);
  Row out;
  ::gradient(tag, 5, start.x.data(), out.data());
  return out;
}

}  // namespace peers
