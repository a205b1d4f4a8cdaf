// A public header of a library. Each macro is a change that a next version might make.
#pragma once

struct Reading {
  double value = 0;
#if defined(CHANGED_LAYOUT)
  double sigma = 0;
#endif
};

class Sensor {
 public:
  virtual ~Sensor();
  virtual Reading read() const;
#if defined(ADDED_VIRTUAL)
  virtual void reset();
#endif
};

double mean(const Sensor& sensor, int count);
#if defined(ADDED_FUNCTION)
double sum(const Sensor& sensor, int count);
#endif
