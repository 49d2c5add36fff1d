#include <lagroid/core/matrices/factored_matrix.hpp>

#include <Eigen/LU>

namespace lagroid {

template <class S>
FactoredMatrix<S>::FactoredMatrix(const Eigen::MatrixX<S>& a)
    : lu_(std::make_shared<const Eigen::PartialPivLU<Eigen::MatrixX<S>>>(a)) {}

template <class S> Eigen::VectorX<S> FactoredMatrix<S>::solve(const Eigen::VectorX<S>& b) const {
  return lu_->solve(b);
}

template <class S> int FactoredMatrix<S>::sign_of_determinant() const {
  int sign = int(lu_->permutationP().determinant());
  for (const S& pivot : lu_->matrixLU().diagonal()) sign *= (pivot > 0) - (pivot < 0);
  return sign;
}

template class FactoredMatrix<double>;
template class FactoredMatrix<long double>;

}  // namespace lagroid
