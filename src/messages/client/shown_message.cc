// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/client/shown_message.hh"

#include "base/language/language.hh"

namespace mw::client {

std::string shown_message(const Viewer::Message &message) {
    return message.kind == messages::MessageKind::OPERATOR_DISPLAY ? message.text
                                                                   : language::shown(message.text);
}

}  // namespace mw::client
