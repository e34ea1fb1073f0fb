// SPDX-License-Identifier: GPL-2.0-or-later
// The client of a program that passes on commands from the network.
#pragma once

#include <string>

#include "messages/client/client.hh"

namespace mw::programs {

/// Commands over TCP are from programs that are not authenticated as the machine's user, so their authority
/// is OPERATE (docs/integrator/security.md).
inline Result<client::Client> connect_to_operate(const std::string &instance) {
    auto client = client::Client::connect(instance);
    if (client.has_value()) {
        client->limit_authority(mailbox::Authority::OPERATE);
    }
    return client;
}

}  // namespace mw::programs
