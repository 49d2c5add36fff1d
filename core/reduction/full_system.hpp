#pragma once
/// Where a reduced system keeps the full one.

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/system.hpp>

#include <utility>

namespace lagroid::detail {

/// Its step and its time, where it has any, are those of the full one.
template <class Sys> struct FullSystem { Sys full; };
template <HasTimeStep Sys>
requires(!TimeDependent<Sys>) struct FullSystem<Sys> {
  Sys full;
  double& h = full.h;

  explicit FullSystem(Sys system) : full(std::move(system)) {}
  FullSystem(const FullSystem& other) : full(other.full) {}
  FullSystem& operator=(const FullSystem& other) {
    full = other.full;
    return *this;
  }
};
template <TimeDependent Sys> struct FullSystem<Sys> {
  Sys full;
  double& h = full.h;
  double& time = full.time;

  explicit FullSystem(Sys system) : full(std::move(system)) {}
  FullSystem(const FullSystem& other) : full(other.full) {}
  FullSystem& operator=(const FullSystem& other) {
    full = other.full;
    return *this;
  }
};

}  // namespace lagroid::detail
