/// Registration of the linear backends and algorithms that were built in.
#pragma once

#include <waymark/core/registry.hpp>

namespace waymark {

/// Backends cholmod, cholmod_simplicial, cholmod_supernodal, csparse (each where built in) and eigen;
/// algorithms gauss_newton, levenberg_marquardt, dogleg.
void register_solvers(TypeRegistry& registry);

}  // namespace waymark
