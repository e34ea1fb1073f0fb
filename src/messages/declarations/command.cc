// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/declarations/command.hh"

#include <memory>

namespace mw::messages {

Command::Command() = default;
Command::Command(const Command &other) = default;
Command::Command(Command &&other) noexcept = default;
Command::~Command() = default;

Command &Command::operator=(const Command &other) {
    return *this = Command(other);
}

/// Constructs the alternative again. An assignment operator for each pair of alternatives would take long to
/// compile.
Command &Command::operator=(Command &&other) noexcept {
    if (this != &other) {
        std::destroy_at(this);
        std::construct_at(this, std::move(other));
    }
    return *this;
}

}  // namespace mw::messages
