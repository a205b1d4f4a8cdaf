#include "sensor.hpp"

namespace {

struct Sum {
  double value = 0;
#if defined(CHANGED_PRIVATE)
  int count = 0;
#endif
};

}  // namespace

Sensor::~Sensor() = default;
Reading Sensor::read() const {
  return {};
}
#if defined(ADDED_VIRTUAL)
void Sensor::reset() {}
#endif
#if defined(ADDED_FUNCTION)
double sum(const Sensor& sensor, int count) {
  return mean(sensor, count) * count;
}
#endif

double mean(const Sensor& sensor, int count) {
  Sum sum;
  for (int i = 0; i < count; ++i) sum.value += sensor.read().value;
  return sum.value / count;
}
