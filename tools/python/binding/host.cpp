#include <waymark/tools/python/binding/host.hpp>

namespace waymark::python {

program::Listener Host::listener() {
  using Kind = program::Listener::Kind;
  return {.said =
              [this](Kind kind, const std::string& text) {
                if (kind == Kind::warning) warnings_.push_back(text);
                if (kind == Kind::note) notes_.push_back(text);
              },
          .progress = [this](const std::string& text) { tell(text, nullptr); },
          .step = [this](const std::string& work, const IterationRecord& record) { tell(work, &record); },
          .waits = [this] { tell({}, nullptr); },
          .cancel = &cancel_};
}

void Host::step(const IterationRecord& record) {
  tell("optimising", &record);
}

void Host::tell(const std::string& text, const IterationRecord* record) {
  if (cancel_) return;
  const py::gil_scoped_acquire acquire;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (progress_.is_none() || (text.empty() && record == nullptr)) return;
    if (record == nullptr) {
      progress_(text, py::none(), py::none());
    } else {
      progress_(text, record->iteration, record->chi2);
    }
  } catch (py::error_already_set& error) {
    failure_.emplace(std::move(error));
    cancel_ = true;
  }
}

void Host::raise() {
  if (!failure_) return;
  const py::error_already_set failure = std::move(*failure_);
  failure_.reset();
  throw failure;
}

}  // namespace waymark::python
