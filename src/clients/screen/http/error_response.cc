// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/http/error_response.hh"

#include <string>

#include "clients/screen/http/json_text.hh"

namespace mw::screen {

Response error_response(int status, std::string_view text) {
    Response response;
    response.status = status;
    response.body = member_text("error", std::string(text));
    return response;
}

}  // namespace mw::screen
