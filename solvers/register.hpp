/// Registration of the linear backends and algorithms that were built in.
#pragma once

#include <waymark/core/registry/registry.hpp>

namespace waymark::solvers {

/// Registers the backends cholmod, cholmod_simplicial, cholmod_supernodal and csparse (if they were
/// built in) and eigen, and the algorithms gauss_newton, levenberg_marquardt and dogleg.
void register_solvers(TypeRegistry& registry);

}  // namespace waymark::solvers
