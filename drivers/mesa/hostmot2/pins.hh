// SPDX-License-Identifier: GPL-2.0-or-later
// Pins and parameters of the modules of a board as tables: a row names a pin or parameter, its direction, and
// the field of a plain struct with its value. The functions of a module work on such structs and know no HAL.
// A new pin is a field and a row.
//
//     struct LedPins { bool lit = false; };
//     constexpr PinRow<LedPins> LED_PINS[] = {{"", Access::IN, &LedPins::lit}};
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mw::mesa {

enum class PinType : std::uint8_t { BIT, FLOAT, S32, U32 };
/// IN, OUT and IO are pins, as seen by the driver; RW and RO are parameters.
enum class Access : std::uint8_t { IN, OUT, IO, RW, RO };

/// Creates pins and parameters: in HAL, or in a map of a test. Names are without the prefix of the board,
/// except for one that begins with WHOLE_NAME.
constexpr char WHOLE_NAME = '/';
class PinSpace {
  public:
    virtual ~PinSpace() = default;

    /// Creates a pin or parameter with the value 0. The slot points to its value and is valid for the life of
    /// the driver; its content may change when a pin is linked to a signal. [while loading]
    virtual void *const volatile *make(const std::string &name, PinType type, Access access) = 0;
    /// A second name of a parameter. [while loading]
    virtual void alias_param(const std::string &name, const std::string &alias) = 0;
};

/// A pin or parameter and the field of `Values` that has its value; the value of the field at the start is
/// the default.
template <class Values>
struct PinRow {
    constexpr PinRow(const char *pin_name, Access pin_access, bool Values::*field) noexcept
        : name(pin_name), access(pin_access), type(PinType::BIT), bit(field) {}
    constexpr PinRow(const char *pin_name, Access pin_access, double Values::*field) noexcept
        : name(pin_name), access(pin_access), type(PinType::FLOAT), real(field) {}
    constexpr PinRow(const char *pin_name, Access pin_access, std::int32_t Values::*field) noexcept
        : name(pin_name), access(pin_access), type(PinType::S32), s32(field) {}
    constexpr PinRow(const char *pin_name, Access pin_access, std::uint32_t Values::*field) noexcept
        : name(pin_name), access(pin_access), type(PinType::U32), u32(field) {}

    void *field_of(Values &values) const noexcept {
        switch (type) {
        case PinType::BIT: return &(values.*bit);
        case PinType::FLOAT: return &(values.*real);
        case PinType::S32: return &(values.*s32);
        case PinType::U32: break;
        }
        return &(values.*u32);
    }

    const char *name;
    Access access;
    PinType type;
    union {
        bool Values::*bit;
        double Values::*real;
        std::int32_t Values::*s32;
        std::uint32_t Values::*u32;
    };
};

/// The pins of a module and the fields with their values. The fields must not move once they are bound.
class PinBinding {
  public:
    /// Creates the pin PREFIX.NAME of each row. [while loading]
    template <class Values, std::size_t N>
    void bind(PinSpace &space, const std::string &prefix, const PinRow<Values> (&rows)[N], Values &values) {
        for (const PinRow<Values> &row : rows) {
            const std::string separator = row.name[0] == '\0' ? "" : ".";
            add(space, prefix + separator + row.name, row.type, row.access, row.field_of(values));
        }
    }
    /// Creates one pin for one field. [while loading]
    void add(PinSpace &space, const std::string &name, PinType type, Access access, void *field);

    /// Returns the same pins with other fields: a field `n` bytes after `from` becomes the field `n` bytes
    /// after `to`. So a second thread has separate values. [while loading]
    PinBinding moved(const void *from, void *to) const;

    /// Copies the values that others may set (IN, IO, RW) to the fields. [servo thread]
    void load() noexcept;
    /// Copies the fields of OUT and RO to HAL, and those of IO and RW that changed since load(), so that a
    /// value set by a user in this time is not overwritten. [servo thread]
    void store() noexcept;

  private:
    struct Bound {
        void *const volatile *slot = nullptr;
        void *field = nullptr;
        std::uint64_t loaded = 0;
        PinType type = PinType::BIT;
        Access access = Access::IN;
    };
    std::vector<Bound> pins_;
};

}  // namespace mw::mesa
