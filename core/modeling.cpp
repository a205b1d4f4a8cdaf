#include <waymark/core/log_reader.hpp>
#include <waymark/core/modeling.hpp>

namespace waymark {

OdometryModel::~OdometryModel() = default;
GnssModeling::~GnssModeling() = default;

}  // namespace waymark
