#pragma once
/// Whether a class has a member of a name, whatever it is.

#include <type_traits>

/// Defines the concept `Concept<C>`: C, or a base of it, has a member called `name`: a function of any arguments, a
/// template, a number, private or not. An optional member is looked for in the form that a method needs; with this one
/// tells a member that is absent from one that does not fit.
///
/// The name of a member of two bases is ambiguous, whatever the members are: so a class derived from C and from one
/// that has the name has no such member to point at. Of a class that is final nothing can be derived; there, members
/// that can be pointed at are seen. So they are where C has a type `MembersVary`: a class template says by it that
/// members of it are there for some of its arguments alone (a requires clause), which looks no different.
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
