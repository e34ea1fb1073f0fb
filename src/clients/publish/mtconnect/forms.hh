// SPDX-License-Identifier: GPL-2.0-or-later
// Converts values to the units and words of MTConnect.
#pragma once

#include <string>

#include "clients/publish/mtconnect/device_model.hh"

namespace mw::publish::mtconnect {

/// UNAVAILABLE without a value. `units_per_mm`: machine units per millimetre.
std::string value_text(const DataItem &item, const Value &value, double units_per_mm);

/// "2026-11-30T10:20:30.125Z"
std::string time_text(TimeMs at);

}  // namespace mw::publish::mtconnect
