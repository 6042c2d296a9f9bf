#include "base/input_error.h"

#include "base/io/printable.h"

namespace stopline {

InputError::InputError(const std::string& message) : std::runtime_error(printable_text(message)) {}

}  // namespace stopline
