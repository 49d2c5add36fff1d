#pragma once
/// Rotations with a frame of their arrows that is wrong.

#include <lagroid/groupoids/groups/so3.hpp>

namespace lagroid {

/// SO(3) with the bracket of its frame reversed, its curves straightened, or both ends moved alike.
enum class FrameFault { bracket, curvature, ends };
template <FrameFault Fault> struct BadlyFramed : SO3 {
  template <class T> static Matrix<T, 3, 3> frame_bracket(const Vector<T, 3>& p) {
    return Fault == FrameFault::bracket ? Matrix<T, 3, 3>(-SO3::frame_bracket(p)) : SO3::frame_bracket(p);
  }
  template <End Which, class T, int K>
  static Matrix<T, 3, K> frame_to_end(const Matrix<T, 3, 3>& g, const Matrix<T, 3, K>& rows) {
    return SO3::frame_to_end < Fault == FrameFault::ends ? End::target : Which > (g, rows);
  }
  template <class J, int Offset = 0, class T> static Matrix<J, 3, 3> frame_jet(const Matrix<T, 3, 3>& g) {
    Matrix<J, 3, 3> out = SO3::frame_jet<J, Offset>(g);
    if constexpr (J::order == 2 && Fault == FrameFault::curvature)
      for (J& x : out.reshaped())
        for (int i = 0; i < 3; ++i) x.set_row(i, typename J::Row{});
    return out;
  }
};

}  // namespace lagroid
