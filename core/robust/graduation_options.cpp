#include <locale>
#include <sstream>

#include <waymark/core/base/error.hpp>
#include <waymark/core/robust/graduation.hpp>

namespace waymark {

GraduationOptions::GraduationOptions() {
  for (const LossType& type : builtin_losses()) {
    if (type.name == "geman_mcclure") loss = Loss{type.name, type.evaluate, 1};
  }
}

void GraduationOptions::check() const {
  const auto require = [](bool valid, const char* field, double value, const char* rule) {
    if (valid) return;
    std::ostringstream message;
    message.imbue(std::locale::classic());
    message << "graduation option " << field << " = " << value << ": must be " << rule;
    throw UsageError(message.str());
  };
  require(loss.evaluate != nullptr && loss.scale > 0, "loss.scale", loss.scale, "> 0, of a known loss");
  require(factor > 1, "factor", factor, "> 1");
  require(inner_iterations >= 1, "inner_iterations", inner_iterations, ">= 1");
  require(inlier_probability > 0 && inlier_probability < 1, "inlier_probability", inlier_probability,
          "in (0, 1)");
  optimizer.check();
}

}  // namespace waymark
