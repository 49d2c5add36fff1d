#pragma once
/// Whether a class has a member of a given name, whatever its type and arguments.
///
/// Methods use optional members where their form fits; this concept distinguishes a member that is absent from one that
/// is there and does not fit, which can then be an error of compilation.
///
///     LAGROID_MEMBER_NAME(NamesEnergy, energy);
///     struct Spring { double energy(int, int) const; };
///     static_assert(NamesEnergy<Spring> && !NamesEnergy<std::string>);
///
/// Requires a class, not a number or an array.

#include <type_traits>

/// Defines the concept `Concept<C>`: C, or a base of it, has a member called `name`: a function of any arguments, a
/// template, a number, private or not.
///
/// The name of a member of two bases is ambiguous, whatever the members are: so a class derived from C and from one
/// that has the name has no such member to point at. Of a class that is final nothing can be derived; there, members
/// that can be pointed at are seen. So they are where C has a type `MembersVary`, by which a class template declares
/// that some of its members exist for some of its arguments alone (a requires clause): the name is there in either
/// case.
#define LAGROID_MEMBER_NAME(Concept, name)                                       \
  struct Concept##Only {                                                         \
    int name;                                                                    \
  };                                                                             \
  template <class C> struct Concept##Beside;                                     \
  template <class C>                                                             \
  requires(!std::is_final_v<C>) struct Concept##Beside<C> : C, Concept##Only {}; \
  template <class C>                                                             \
  concept Concept = requires {                                                   \
    &C::name;                                                                    \
  }                                                                              \
  || (                                                                           \
         !std::is_final_v<C> && !requires { typename C::MembersVary; } && !requires { &Concept##Beside<C>::name; })
