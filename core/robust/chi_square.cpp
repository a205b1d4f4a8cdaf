#include <cmath>
#include <numbers>

#include <waymark/core/robust/chi_square.hpp>

namespace waymark {

double chi_square_tail(double x, int freedom) {
  if (x <= 0) return 1;
  const double half = 0.5 * x;
  const bool even = freedom % 2 == 0;
  double tail = even ? std::exp(-half) : std::erfc(std::sqrt(half));
  // Two more degrees of freedom add half^(d/2) e^(-half) / Gamma(d/2 + 1). Of many degrees the first of these
  // terms are too small for a double, and the last ones are not.
  double log_term = even ? std::log(half) - half : std::log(2 * std::sqrt(half / std::numbers::pi)) - half;
  for (int d = even ? 2 : 1; d < freedom; d += 2) {
    tail += std::exp(log_term);
    log_term += std::log(half / (0.5 * d + 1));
  }
  return tail;
}

double chi_square_quantile(double probability, int freedom) {
  double low = 0;
  double high = freedom;
  while (1 - chi_square_tail(high, freedom) < probability) high *= 2;
  while (high - low > 1e-14 * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (1 - chi_square_tail(middle, freedom) < probability ? low : high) = middle;
  }
  return high;
}

}  // namespace waymark
