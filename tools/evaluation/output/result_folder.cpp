#include <waymark/tools/evaluation/output/result_folder.hpp>

namespace waymark::evaluation {

std::vector<std::string> ResultFolder::files(std::span<const std::string> labels) const {
  std::vector<std::string> all;
  for (const std::string& label : labels) {
    all.insert(all.end(), {graph(label), fused_graph(label)});
    for (const std::string_view form : kTrajectoryForms) all.push_back(trajectory(label, form));
    all.insert(all.end(), {epochs(label), page(label)});
  }
  all.insert(all.end(), {page(kReport), metrics(), summary()});
  return all;
}

}  // namespace waymark::evaluation
