#pragma once
/// NumPy arrays over numbers that C++ keeps.

#include <Eigen/Core>

#include <pybind11/numpy.h>

#include <utility>
#include <vector>

namespace lagroid::python {

namespace py = pybind11;

/// A read-only array over `data`, which `owner` keeps alive; nothing is copied. Strides are in numbers.
inline py::array view(const double* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
                      py::handle owner) {
  for (py::ssize_t& stride : strides) stride *= py::ssize_t(sizeof(double));
  py::array out(py::dtype::of<double>(), std::move(shape), std::move(strides), data, owner);
  out.attr("flags").attr("writeable") = false;
  return out;
}

/// Of one dimension.
inline py::array view(const std::vector<double>& numbers, py::handle owner) {
  return view(numbers.data(), {py::ssize_t(numbers.size())}, {1}, owner);
}

/// An array that owns what was moved into it.
inline py::array owned(std::vector<double> numbers) {
  auto* kept = new std::vector<double>(std::move(numbers));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<double>*>(p); });
  return py::array(py::dtype::of<double>(), {py::ssize_t(kept->size())}, {py::ssize_t(sizeof(double))}, kept->data(),
                   owner);
}

/// Of an Eigen matrix, moved in: columns first in memory.
inline py::array owned(Eigen::MatrixXd numbers) {
  auto* kept = new Eigen::MatrixXd(std::move(numbers));
  const py::capsule owner(kept, [](void* p) { delete static_cast<Eigen::MatrixXd*>(p); });
  const auto one = py::ssize_t(sizeof(double));
  return py::array(py::dtype::of<double>(), {kept->rows(), kept->cols()}, {one, one * kept->rows()}, kept->data(),
                   owner);
}

}  // namespace lagroid::python
