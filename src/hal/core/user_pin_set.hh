// SPDX-License-Identifier: GPL-2.0-or-later
// The pins of a table (hal/sdk/pin_table.hh) in an ordinary program; sdk::PinSet is for modules.
#pragma once

#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "hal/core/user_pin.hh"
#include "hal/sdk/pin_table.hh"

namespace mw::hal {

/// Name of a row's pin for an instance: SCOPE.NAME with the number inserted.
inline std::string pin_name(const char *scope, const char *name, int number) {
    char first[HAL_NAME_LEN + 1], second[HAL_NAME_LEN + 1];
    sdk::expand_name(scope, number, first);
    sdk::expand_name(name, number, second);
    return std::string(first) + '.' + second;
}

/// The pins of one instance of the table. [the thread that owns the component]
template <const auto &TABLE>
class UserPinSet {
  public:
    /// Creates the pins; `status` keeps the first failure of several calls.
    void make(Instance &hal, int comp_id, int number, Result<> &status) {
        each(pins_, [&](const auto &row, auto &pin) {
            pin.make(hal, comp_id, pin_name(TABLE.scope, row.name, number), static_cast<Dir>(row.DIRECTION),
                     status);
            if (status.has_value()) {
                pin = row.start;
            }
        });
    }
    template <class In>
    void read(In &in) const {
        each(pins_, [&](const auto &row, const auto &pin) {
            if constexpr (!std::is_same_v<decltype(row.read), sdk::Unused>) {
                row.read(in, pin.get());
            }
        });
    }
    template <class Out>
    void write(const Out &out) {
        each(pins_, [&](const auto &row, auto &pin) {
            using Row = std::remove_cvref_t<decltype(row)>;
            if constexpr (!std::is_same_v<decltype(row.write), sdk::Unused>) {
                static_assert(Row::DIRECTION == HAL_OUT, "only modules have pins that both sides write");
                pin = static_cast<typename Row::Value>(row.write(out));
            }
        });
    }

  private:
    template <class... Rows>
    static std::tuple<UserPin<typename Rows::Value>...> pins_of(const sdk::PinTable<Rows...> &);

    template <class Pins, class Each>
    static void each(Pins &pins, Each &&step) {
        [&]<std::size_t... I>(std::index_sequence<I...>) {
            (step(std::get<I>(TABLE.rows), std::get<I>(pins)), ...);
        }(std::make_index_sequence<std::tuple_size_v<decltype(TABLE.rows)>>());
    }

    decltype(pins_of(TABLE)) pins_;
};

}  // namespace mw::hal
