#include "allocation/calibrated_problem.hpp"

#include "support/calibrated_drive.hpp"

namespace waymark_test {

waymark::Graph calibrated_problem(const waymark::TypeRegistry& registry) {
  return calibrated_drive(registry, 9000);
}

}  // namespace waymark_test
