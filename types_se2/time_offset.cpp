#include <waymark/types_se2/time_offset.hpp>

namespace waymark {

template class EdgeBatch<EdgeGnssPositionDelayed>;

}  // namespace waymark
