// SPDX-License-Identifier: GPL-2.0-or-later
// Common code of multiplexers and demultiplexers of any type and size: their config= and copying between
// types.
#pragma once

#include "components/conv/conv_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

constexpr int MAX_SIZE = 1024;
constexpr int MAX_SELECT_BITS = 10;

struct TypeLetter {
    char letter;
    hal_type_t type;
    const char *name;
};
constexpr TypeLetter TYPES[] = {{'b', HAL_BIT, "bit"}, {'f', HAL_FLOAT, "float"}, {'s', HAL_S32, "s32"},
                                {'u', HAL_U32, "u32"}, {'l', HAL_S64, "s64"},     {'k', HAL_U64, "u64"}};

struct Config {
    const TypeLetter *from = nullptr;
    const TypeLetter *to = nullptr;
    int size = 0;

    /// Reads one item of config=. False when it is invalid.
    bool parse(const char *text) noexcept {
        for (; *text != '\0'; ++text) {
            if (*text >= '0' && *text <= '9') {
                size = 10 * size + (*text - '0');
                if (size > MAX_SIZE) {
                    return false;
                }
                continue;
            }
            const char letter = static_cast<char>(*text | 0x20);
            const TypeLetter *found = nullptr;
            for (const TypeLetter &type : TYPES) {
                found = type.letter == letter ? &type : found;
            }
            if (found == nullptr || to != nullptr) {
                return false;
            }
            (from == nullptr ? from : to) = found;
        }
        return to != nullptr && size >= 2;
    }
};

/// Copies a value to a value of another type; a value that does not fit becomes the nearest one.
template <class From>
void copy_value(From value, hal_type_t to, hal_data_u *output) noexcept {
    switch (to) {
    case HAL_BIT: output->b = conv::convert<bool>(value, false).value; break;
    case HAL_FLOAT: output->f = conv::convert<double>(value, true).value; break;
    case HAL_S32: output->s = conv::convert<std::int32_t>(value, true).value; break;
    case HAL_U32: output->u = conv::convert<std::uint32_t>(value, true).value; break;
    case HAL_S64: output->ls = conv::convert<std::int64_t>(value, true).value; break;
    default: output->lu = conv::convert<std::uint64_t>(value, true).value; break;
    }
}

/// Copies the value of a pin.
inline void copy_pin(const hal_data_u *input, hal_type_t from, hal_type_t to, hal_data_u *output) noexcept {
    switch (from) {
    case HAL_BIT: copy_value(static_cast<bool>(input->b), to, output); break;
    case HAL_FLOAT: copy_value(static_cast<double>(input->f), to, output); break;
    case HAL_S32: copy_value(static_cast<std::int32_t>(input->s), to, output); break;
    case HAL_U32: copy_value(static_cast<std::uint32_t>(input->u), to, output); break;
    case HAL_S64: copy_value(static_cast<std::int64_t>(input->ls), to, output); break;
    default: copy_value(static_cast<std::uint64_t>(input->lu), to, output); break;
    }
}

/// Loads one T for each item of config=: PREFIX.00, PREFIX.01, ... A T has a `shape` and declares its pins.
/// Returns the component id, or a negated errno.
template <class T>
int load_generic(const char *module, const char *prefix, char *const *config, int max) noexcept {
    const int comp_id = hal_init(module);
    if (comp_id < 0) {
        return comp_id;
    }
    int status = 0;
    int count = 0;
    for (; status == 0 && count < max && config[count] != nullptr; ++count) {
        T *made = make<T>();
        if (made == nullptr) {
            status = -ENOMEM;
        } else if (!made->shape.parse(config[count])) {
            rtapi_print_msg(
                RTAPI_MSG_ERR,
                "%s: config item '%s' is not two of the letters b f s u l k and a size of 2 to %d", module,
                config[count], MAX_SIZE);
            status = -EINVAL;
        } else {
            Name name;
            rtapi_snprintf(name.text, sizeof name.text, "%s.%02d", prefix, count);
            Declare declare(comp_id, name.text, count);
            made->declare(declare);
            status = declare.status();
        }
    }
    if (count == 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "%s: config= is missing, for example config=ff8", module);
        status = -EINVAL;
    }
    return finish(comp_id, status);
}

}  // namespace mw::components
