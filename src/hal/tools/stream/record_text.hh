// SPDX-License-Identifier: GPL-2.0-or-later
// Records of sampler and streamer as lines of text, in the format of halsampler and halstreamer.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "hal/include/hal.h"

namespace mw::hal::stream_tools {

/// The values, each followed by a blank: floats with six decimals, bits as 0 and 1, integers in decimal.
std::string format_record(const std::vector<hal_type_t> &types, const hal_stream_data_u *values);

/// True for lines without a record: empty, or starting with '#'.
bool isSkipped(std::string_view line);

/// The fields of a line, separated by blanks; text after the last one is ignored.
Result<std::vector<hal_stream_data_u>> parse_record(const std::vector<hal_type_t> &types,
                                                    std::string_view line);

}  // namespace mw::hal::stream_tools
