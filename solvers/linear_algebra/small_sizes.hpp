#pragma once
/// The sizes of step equations, one to ten, of which the linear algebra is compiled once, in the library; larger ones
/// are compiled where they are used.

#define LAGROID_FOR_SMALL_SIZES(of) \
  of<1>;                            \
  of<2>;                            \
  of<3>;                            \
  of<4>;                            \
  of<5>;                            \
  of<6>;                            \
  of<7>;                            \
  of<8>;                            \
  of<9>;                            \
  of<10>
