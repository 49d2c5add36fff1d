#include <lagroid/core/matrices/real_schur.hpp>

#include <Eigen/Eigenvalues>

namespace lagroid {

template <class S> RealSchurForm<S> real_schur(const Eigen::MatrixX<S>& a) {
  const Eigen::RealSchur<Eigen::MatrixX<S>> schur(a);
  return {schur.matrixT(), schur.matrixU()};
}

template RealSchurForm<double> real_schur(const Eigen::MatrixX<double>&);
template RealSchurForm<long double> real_schur(const Eigen::MatrixX<long double>&);

}  // namespace lagroid
