// SPDX-License-Identifier: GPL-2.0-or-later
// Shared memory keys of the streams between sampler, streamer and their programs; the channel's number is
// added.
#pragma once

namespace mw::hal::stream_tools {

inline constexpr int SAMPLER_KEY = 0x4d570100;
inline constexpr int STREAMER_KEY = 0x4d570200;
/// Maximum number of channels of one type.
inline constexpr int MAX_CHANNELS = 8;

}  // namespace mw::hal::stream_tools
