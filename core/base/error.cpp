#include <waymark/core/base/error.hpp>

namespace waymark {

Error::~Error() = default;
UsageError::~UsageError() = default;
InputError::~InputError() = default;
OutputError::~OutputError() = default;

}  // namespace waymark
