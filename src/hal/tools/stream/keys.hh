// SPDX-License-Identifier: GPL-2.0-or-later
// Where the streams between sampler, streamer and their programs are: shared memory keys, plus the channel's
// number.
#pragma once

namespace mw::hal::stream_tools {

inline constexpr int SAMPLER_KEY = 0x4d570100;
inline constexpr int STREAMER_KEY = 0x4d570200;
/// Most channels of one kind.
inline constexpr int MAX_CHANNELS = 8;

}  // namespace mw::hal::stream_tools
