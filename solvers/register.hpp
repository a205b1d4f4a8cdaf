/// Registration of the linear backends and algorithms that were built in.
#pragma once

#include <waymark/core/registry/registry.hpp>

namespace waymark::solvers {

/// Backends cholmod, cholmod_simplicial, cholmod_supernodal, csparse (each where built in) and eigen;
/// algorithms gauss_newton, levenberg_marquardt, dogleg.
void register_solvers(TypeRegistry& registry);

}  // namespace waymark::solvers
