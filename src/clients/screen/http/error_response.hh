// SPDX-License-Identifier: GPL-2.0-or-later
// The answer to a request that failed.
#pragma once

#include <string_view>

#include "clients/screen/http/http_types.hh"

namespace mw::screen {

/// {"error": "..."} with its HTTP status.
Response error_response(int status, std::string_view text);

}  // namespace mw::screen
