// SPDX-License-Identifier: GPL-2.0-or-later
// Pins declared once: a row of a table names a pin, its direction, type, unit and meaning, and defines how it
// is read or written. The table generates the pins in HAL, the transfer in each cycle and the manual page; a
// new pin needs only one row (docs/developer/extending/pin.md).
//
//     constexpr auto AXIS_PINS = sdk::pin_table("axis.@",
//         sdk::in<bool>("jog-enable", "", "the wheel is on", [](AxisIn &a, bool v) { a.isEnabled = v; }),
//         sdk::out<double>("pos-cmd", "unit", "commanded position", [](const AxisOut &a) { return a.position;
//         }));
//
//     sdk::PinSet<AXIS_PINS> pins;      // the pins of one axis
//     pins.declare(comp_id, 0);         // axis.x.jog-enable, axis.x.pos-cmd
//     pins.read(in);                    // all rows with a read function
//     pins.write(out);                  // all rows with a write function
//
// In names # is replaced by the number of the instance, ## by the number with two digits, @ by the letter of
// an axis.
#pragma once

#include <tuple>
#include <utility>

#include "hal/sdk/component.hh"

namespace mw::sdk {

/// For pins without a function: they exist only by name, or keep their first value.
struct Unused {};

template <class T, hal_pin_dir_t DIR, class Read, class Write>
struct PinRow {
    using Value = T;
    static constexpr hal_pin_dir_t DIRECTION = DIR;
    const char *name;
    const char *unit;  ///< "" if there is none
    const char *doc;
    Read read;    ///< (In &, T): uses the value of the pin
    Write write;  ///< (const Out &) -> T: value for the pin
    T start{};
};

template <class T, class Read>
constexpr auto in(const char *name, const char *unit, const char *doc, Read read, T start = T{}) {
    return PinRow<T, HAL_IN, Read, Unused>{name, unit, doc, read, {}, start};
}
template <class T, class Write>
constexpr auto out(const char *name, const char *unit, const char *doc, Write write) {
    return PinRow<T, HAL_OUT, Unused, Write>{name, unit, doc, {}, write};
}
/// The pin is written only when its value changes, because the reader resets it.
template <class T, class Read, class Write>
constexpr auto in_out(const char *name, const char *unit, const char *doc, Read read, Write write) {
    return PinRow<T, HAL_IO, Read, Write>{name, unit, doc, read, write};
}

template <class... Rows>
struct PinTable {
    const char *scope;  ///< prefix before the first dot, or before the last but one
    std::tuple<Rows...> rows;
};
template <class... Rows>
constexpr auto pin_table(const char *scope, Rows... rows) {
    return PinTable<Rows...>{scope, {rows...}};
}

/// Calls `show(scope, row)` for every row.
template <class Table, class Show>
void for_each_pin(const Table &table, Show &&show) {
    std::apply([&](const auto &...row) { (show(table.scope, row), ...); }, table.rows);
}

/// `pattern` with the number inserted. [while loading]
inline void expand_name(const char *pattern, int number, char (&out)[HAL_NAME_LEN + 1]) noexcept {
    constexpr char LETTERS[] = "xyzabcuvw";
    int n = 0;
    for (const char *c = pattern; *c != '\0' && n < HAL_NAME_LEN - 3; ++c) {
        if (*c == '@') {
            out[n++] = LETTERS[number];
        } else if (*c == '#') {
            const bool are_two = c[1] == '#';
            c += are_two ? 1 : 0;
            n += rtapi_snprintf(out + n, 4, are_two ? "%02d" : "%d", number);
        } else {
            out[n++] = *c;
        }
    }
    out[n] = '\0';
}

/// The pins of one instance of a table's scope, in HAL memory.
template <const auto &TABLE>
class PinSet {
  public:
    /// For a table whose names have no number; otherwise as the function below. [while loading]
    int declare(int comp_id) noexcept { return declare(comp_id, 0); }
    /// 0 or a negated errno. [while loading]
    int declare(int comp_id, int number) noexcept {
        char scope[HAL_NAME_LEN + 1];
        expand_name(TABLE.scope, number, scope);
        Declare d(comp_id, scope, number);
        each([&](const auto &row, auto &cell) {
            char name[HAL_NAME_LEN + 1];
            expand_name(row.name, number, name);
            d.pin(cell.pin, name, row.start);
        });
        return d.status();
    }
    /// [servo]
    template <class In>
    void read(In &in) noexcept {
        each([&](const auto &row, auto &cell) {
            if constexpr (!std::is_same_v<decltype(row.read), Unused>) {
                row.read(in, cell.pin.get());
            }
        });
    }
    /// [servo]
    template <class Out>
    void write(const Out &out) noexcept {
        each([&](const auto &row, auto &cell) {
            using Row = std::remove_cvref_t<decltype(row)>;
            using Value = typename Row::Value;
            if constexpr (!std::is_same_v<decltype(row.write), Unused>) {
                const auto value = static_cast<Value>(row.write(out));
                if constexpr (Row::DIRECTION == HAL_IO) {
                    if (value != cell.last) {
                        cell.pin = value;
                        cell.last = value;
                    }
                } else {
                    cell.pin = value;
                }
            }
        });
    }

  private:
    template <class Row>
    struct Cell {
        Pin<typename Row::Value, Row::DIRECTION> pin;
        [[no_unique_address]] std::conditional_t<Row::DIRECTION == HAL_IO, typename Row::Value, Unused>
            last{};
    };
    template <class... Rows>
    static std::tuple<Cell<Rows>...> cells_of(const PinTable<Rows...> &);

    template <class Each>
    void each(Each &&step) noexcept {
        [&]<std::size_t... I>(std::index_sequence<I...>) {
            (step(std::get<I>(TABLE.rows), std::get<I>(cells_)), ...);
        }(std::make_index_sequence<std::tuple_size_v<decltype(TABLE.rows)>>());
    }

    decltype(cells_of(TABLE)) cells_;
};

}  // namespace mw::sdk
