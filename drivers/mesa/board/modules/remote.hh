// SPDX-License-Identifier: GPL-2.0-or-later
// Smart serial remotes: cards that describe their own data. Source: shared/hardware.md, part B9, for the
// 7I76; for other cards the names of the data are from the manual page sserial(9), and the widths are
// examples.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace mw::mesa::board {

enum class FieldType : std::uint8_t {
    PAD = 0,
    BITS = 1,
    UNSIGNED = 2,
    SIGNED = 3,
    NON_VOLATILE_UNSIGNED = 4,
    STREAM = 6,
    BOOLEAN = 7,
    ENCODER = 8,
    ENCODER_HIGH = 0x18
};
enum class FieldDirection : std::uint8_t { INPUT = 0, BOTH = 0x40, OUTPUT = 0x80 };

/// One process data record of a card.
struct RemoteField {
    std::string_view name, unit;
    std::uint8_t bits = 0;
    FieldType type = FieldType::BITS;
    FieldDirection direction = FieldDirection::INPUT;  ///< as seen by the host, which reads an INPUT
    float min = 0, max = 0;
    std::uint8_t first_mode = 0, last_mode = 255;  ///< range of modes in which the card has the field
};

struct RemoteMode {
    std::string_view name;
    std::uint8_t index = 0;
};

/// A value that is read and written only in set-up mode.
struct RemoteGlobal {
    std::string_view name;
    std::uint8_t bits = 0;
    FieldType type = FieldType::UNSIGNED;
    std::uint32_t value = 0;  ///< at power-up; 0: the serial number
};

/// A type of card, or the part of it on one channel.
struct RemoteCard {
    std::string_view key;   ///< key in the physics file
    std::string_view name;  ///< 4 characters, as reported by the card: 7I76
    std::span<const RemoteField> fields;
    std::span<const RemoteMode> modes;
    std::span<const RemoteGlobal> globals;
    std::string_view
        next_channel;  ///< the key of the part on the next channel; empty: the card has one channel
};

/// The known cards, in upper or lower case: 7i73, 7i76, 7i77 (two channels), 7i84. nullptr: unknown.
const RemoteCard *find_remote_card(std::string_view name);
std::vector<std::string_view> remote_card_names();

/// The three user registers of a channel.
using UserWords = std::array<std::uint32_t, 3>;

/// A card on a channel. [one thread]
class Remote {
  public:
    Remote(const RemoteCard &card, std::uint32_t serial_number);

    /// Content of the user registers after the start of set-up: serial number, name, addresses of the lists.
    UserWords identity() const;
    /// From now on the fields of this mode are exchanged.
    void set_mode(std::uint8_t mode);
    std::uint8_t read_byte(std::uint16_t address) const;
    void write_byte(std::uint16_t address, std::uint8_t value);
    /// Takes the outputs of the host; returns the inputs.
    UserWords exchange(const UserWords &from_host);

    /// Sets an input of the card, by the name of the field.
    void set_value(std::string_view field, std::uint32_t value);
    std::uint32_t value(std::string_view field) const;

  private:
    bool isInMode(const RemoteField &field) const;
    std::uint16_t append_field(const RemoteField &field, std::uint16_t value_address);
    void append_list(const std::vector<std::uint16_t> &addresses);
    void append_text(std::string_view text);
    void describe();

    const RemoteCard *card_;
    std::uint32_t serial_number_;
    std::uint8_t mode_ = 0;
    std::uint16_t process_list_ = 0, global_list_ = 0;
    std::vector<std::uint8_t> memory_;
    std::vector<std::uint32_t> values_;  ///< values by field
};

}  // namespace mw::mesa::board
