// SPDX-License-Identifier: GPL-2.0-or-later
// The answer of a serial absolute encoder as fields, by the formats ssi_chan_N=, biss_chan_N= and
// fanuc_chan_N= of config=. A format is a list of NAME%BITSTYPE, the lowest bits first:
//
//     error%1bposition%24ge
//
// | type | field |
// |---|---|
// | p | padding, no pin |
// | b | bit: NAME, NAME-not |
// | u, s | unsigned, signed number: NAME, with the parameter NAME-scalemax |
// | f | a bit for each: NAME-NN, NAME-NN-not |
// | e | encoder: NAME.count, rawcounts, position, index-enable, reset; scale, counts-per-rev |
// | l, h | low and high part of one encoder |
// | g, m before the type | Gray code; an encoder that counts revolutions and does not wrap |
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "drivers/mesa/hostmot2/modules/bit_fields.hh"

namespace mw::mesa {

struct NamedField {
    std::string name;
    BitField field;
};

/// Fields of a format, at most `most_bits` together. An error names the part that is wrong. A format that
/// ends with g or m without a type is an encoder. AA64 is the format of Fanuc's encoders. [not realtime]
Result<std::vector<NamedField>> parse_field_format(std::string_view format, int most_bits);

}  // namespace mw::mesa
