// SPDX-License-Identifier: GPL-2.0-or-later
// hal.h: pins and parameters.
#include <cstdarg>
#include <cstring>

#include "hal/core/detail/capi.hh"
#include "runtime/format.hh"

namespace mw::hal::detail {
namespace {

Type type_of(hal_type_t type) {
    return static_cast<Type>(type);
}

/// A name formatted as by printf; empty, and reported, when it is too long.
struct FormattedName {
    char text[NAME_LENGTH + 1];
    bool good;

    FormattedName(const char *format, std::va_list args) {
        const int length = runtime::format_text(text, sizeof text, format, args);
        good = length > 0 && length <= static_cast<int>(NAME_LENGTH);
        if (!good) {
            complain(EINVAL, fmt::format("HAL name '{}...' has {} characters, 1 to {} are allowed", text,
                                         length, NAME_LENGTH));
        }
    }
};

int new_pin(const char *name, hal_type_t type, hal_pin_dir_t dir, void **slot, int comp_id) {
    return with_hal([&](Hal &hal) {
        return status_of(hal.new_pin(name, type_of(type), static_cast<Dir>(dir), slot, comp_id));
    });
}

int new_param(const char *name, hal_type_t type, hal_param_dir_t dir, const volatile void *address,
              int comp_id) {
    return with_hal([&](Hal &hal) {
        return status_of(
            hal.new_param(name, type_of(type), static_cast<Dir>(dir), const_cast<void *>(address), comp_id));
    });
}

int set_param(const char *name, const Value &value) {
    return with_hal([&](Hal &hal) {
        const auto param = hal.get_param(name);
        return param ? status_of(hal.set(name, value)) : status_of(Result<>(std::unexpected(param.error())));
    });
}

/// For the newer interface of LinuxCNC: a pin's slot, or a parameter with its own memory.
int new_reference(int comp_id, hal_pdir_t dir, void **ref, const Value &start, const char *name) {
    return with_hal([&](Hal &hal) {
        if (hal_pdir_is_pin(dir) == 0) {
            void *memory = hal.allocate(sizeof(std::uint64_t));
            if (memory == nullptr) {
                return status_of(Result<>(refuse(ENOMEM, "no HAL memory left")));
            }
            *ref = memory;
            hal.impl().write(hal.impl().segment.offset_of(memory), start);
            return new_param(name, static_cast<hal_type_t>(start.type), dir, memory, comp_id);
        }
        const int status = new_pin(name, static_cast<hal_type_t>(start.type), dir, ref, comp_id);
        if (status == 0) {
            hal.impl().write(hal.impl().segment.offset_of(*ref), start);
        }
        return status;
    });
}

template <class T>
void **slot_of(T **data_ptr_addr) {
    return reinterpret_cast<void **>(const_cast<std::remove_volatile_t<T> **>(data_ptr_addr));
}

}  // namespace
}  // namespace mw::hal::detail

using namespace mw;
using namespace mw::hal;
using namespace mw::hal::detail;

extern "C" {

int hal_pin_new(const char *name, hal_type_t type, hal_pin_dir_t dir, void **data_ptr_addr, int comp_id) {
    return new_pin(name, type, dir, data_ptr_addr, comp_id);
}

int hal_param_new(const char *name, hal_type_t type, hal_param_dir_t dir, void *data_addr, int comp_id) {
    return new_param(name, type, dir, data_addr, comp_id);
}

int hal_param_set(const char *name, hal_type_t type, void *value_addr) {
    Value value{type_of(type), 0};
    const std::size_t size = type == HAL_BIT ? 1 : type == HAL_S32 || type == HAL_U32 ? 4 : 8;
    std::memcpy(&value.bits, value_addr, size);
    return set_param(name, value);
}

int hal_pin_bit_new(const char *name, hal_pin_dir_t dir, hal_bit_t **data_ptr_addr, int comp_id) {
    return new_pin(name, HAL_BIT, dir, slot_of(data_ptr_addr), comp_id);
}

int hal_pin_bit_newf(hal_pin_dir_t dir, hal_bit_t **data_ptr_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_pin(name.text, HAL_BIT, dir, slot_of(data_ptr_addr), comp_id) : -EINVAL;
}

int hal_pin_float_new(const char *name, hal_pin_dir_t dir, hal_float_t **data_ptr_addr, int comp_id) {
    return new_pin(name, HAL_FLOAT, dir, slot_of(data_ptr_addr), comp_id);
}

int hal_pin_float_newf(hal_pin_dir_t dir, hal_float_t **data_ptr_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_pin(name.text, HAL_FLOAT, dir, slot_of(data_ptr_addr), comp_id) : -EINVAL;
}

int hal_pin_u32_new(const char *name, hal_pin_dir_t dir, hal_u32_t **data_ptr_addr, int comp_id) {
    return new_pin(name, HAL_U32, dir, slot_of(data_ptr_addr), comp_id);
}

int hal_pin_u32_newf(hal_pin_dir_t dir, hal_u32_t **data_ptr_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_pin(name.text, HAL_U32, dir, slot_of(data_ptr_addr), comp_id) : -EINVAL;
}

int hal_pin_s32_new(const char *name, hal_pin_dir_t dir, hal_s32_t **data_ptr_addr, int comp_id) {
    return new_pin(name, HAL_S32, dir, slot_of(data_ptr_addr), comp_id);
}

int hal_pin_s32_newf(hal_pin_dir_t dir, hal_s32_t **data_ptr_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_pin(name.text, HAL_S32, dir, slot_of(data_ptr_addr), comp_id) : -EINVAL;
}

int hal_pin_u64_new(const char *name, hal_pin_dir_t dir, hal_u64_t **data_ptr_addr, int comp_id) {
    return new_pin(name, HAL_U64, dir, slot_of(data_ptr_addr), comp_id);
}

int hal_pin_u64_newf(hal_pin_dir_t dir, hal_u64_t **data_ptr_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_pin(name.text, HAL_U64, dir, slot_of(data_ptr_addr), comp_id) : -EINVAL;
}

int hal_pin_s64_new(const char *name, hal_pin_dir_t dir, hal_s64_t **data_ptr_addr, int comp_id) {
    return new_pin(name, HAL_S64, dir, slot_of(data_ptr_addr), comp_id);
}

int hal_pin_s64_newf(hal_pin_dir_t dir, hal_s64_t **data_ptr_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_pin(name.text, HAL_S64, dir, slot_of(data_ptr_addr), comp_id) : -EINVAL;
}

int hal_pin_port_new(const char *name, hal_pin_dir_t dir, hal_port_t **data_ptr_addr, int comp_id) {
    return new_pin(name, HAL_PORT, dir, slot_of(data_ptr_addr), comp_id);
}

int hal_pin_port_newf(hal_pin_dir_t dir, hal_port_t **data_ptr_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_pin(name.text, HAL_PORT, dir, slot_of(data_ptr_addr), comp_id) : -EINVAL;
}

int hal_param_bit_new(const char *name, hal_param_dir_t dir, hal_bit_t *data_addr, int comp_id) {
    return new_param(name, HAL_BIT, dir, data_addr, comp_id);
}

int hal_param_bit_newf(hal_param_dir_t dir, hal_bit_t *data_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_param(name.text, HAL_BIT, dir, data_addr, comp_id) : -EINVAL;
}

int hal_param_bit_set(const char *name, int value) {
    return set_param(name, Value::of_bit(value != 0));
}

int hal_param_float_new(const char *name, hal_param_dir_t dir, hal_float_t *data_addr, int comp_id) {
    return new_param(name, HAL_FLOAT, dir, data_addr, comp_id);
}

int hal_param_float_newf(hal_param_dir_t dir, hal_float_t *data_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_param(name.text, HAL_FLOAT, dir, data_addr, comp_id) : -EINVAL;
}

int hal_param_float_set(const char *name, double value) {
    return set_param(name, Value::of_float(value));
}

int hal_param_u32_new(const char *name, hal_param_dir_t dir, hal_u32_t *data_addr, int comp_id) {
    return new_param(name, HAL_U32, dir, data_addr, comp_id);
}

int hal_param_u32_newf(hal_param_dir_t dir, hal_u32_t *data_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_param(name.text, HAL_U32, dir, data_addr, comp_id) : -EINVAL;
}

int hal_param_u32_set(const char *name, unsigned long value) {
    return set_param(name, Value::of_u32(static_cast<rtapi_u32>(value)));
}

int hal_param_s32_new(const char *name, hal_param_dir_t dir, hal_s32_t *data_addr, int comp_id) {
    return new_param(name, HAL_S32, dir, data_addr, comp_id);
}

int hal_param_s32_newf(hal_param_dir_t dir, hal_s32_t *data_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_param(name.text, HAL_S32, dir, data_addr, comp_id) : -EINVAL;
}

int hal_param_s32_set(const char *name, signed long value) {
    return set_param(name, Value::of_s32(static_cast<rtapi_s32>(value)));
}

int hal_param_u64_new(const char *name, hal_param_dir_t dir, hal_u64_t *data_addr, int comp_id) {
    return new_param(name, HAL_U64, dir, data_addr, comp_id);
}

int hal_param_u64_newf(hal_param_dir_t dir, hal_u64_t *data_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_param(name.text, HAL_U64, dir, data_addr, comp_id) : -EINVAL;
}

int hal_param_u64_set(const char *name, unsigned long value) {
    return set_param(name, Value::of_u64(value));
}

int hal_param_s64_new(const char *name, hal_param_dir_t dir, hal_s64_t *data_addr, int comp_id) {
    return new_param(name, HAL_S64, dir, data_addr, comp_id);
}

int hal_param_s64_newf(hal_param_dir_t dir, hal_s64_t *data_addr, int comp_id, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good ? new_param(name.text, HAL_S64, dir, data_addr, comp_id) : -EINVAL;
}

int hal_param_s64_set(const char *name, signed long value) {
    return set_param(name, Value::of_s64(value));
}

int hal_pin_new_port(int compid, hal_pin_dir_t dir, hal_sint_t *ref, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    return name.good && hal_pdir_is_pin(dir) != 0
               ? new_pin(name.text, HAL_PORT, dir, reinterpret_cast<void **>(ref), compid)
               : -EINVAL;
}

int hal_param_new_fake(int compid, hal_refs_u *refs) {
    return with_hal([&](Hal &hal) {
        if (refs == nullptr || !hal.component(compid)) {
            return complain(EINVAL, fmt::format("there is no component {}", compid));
        }
        refs->p = hal.allocate(sizeof(std::uint64_t));
        return refs->p == nullptr ? complain(ENOMEM, "no HAL memory left") : 0;
    });
}

int hal_pin_new_bool(int compid, hal_pdir_t dir, hal_bool_t *ref, rtapi_bool def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_pin(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_bit(def), name.text)
               : -EINVAL;
}

int hal_param_new_bool(int compid, hal_pdir_t dir, hal_bool_t *ref, rtapi_bool def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_param(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_bit(def), name.text)
               : -EINVAL;
}

int hal_pin_new_real(int compid, hal_pdir_t dir, hal_real_t *ref, rtapi_real def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_pin(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_float(def), name.text)
               : -EINVAL;
}

int hal_param_new_real(int compid, hal_pdir_t dir, hal_real_t *ref, rtapi_real def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_param(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_float(def), name.text)
               : -EINVAL;
}

int hal_pin_new_sint(int compid, hal_pdir_t dir, hal_sint_t *ref, rtapi_sint def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_pin(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_s64(def), name.text)
               : -EINVAL;
}

int hal_param_new_sint(int compid, hal_pdir_t dir, hal_sint_t *ref, rtapi_sint def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_param(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_s64(def), name.text)
               : -EINVAL;
}

int hal_pin_new_uint(int compid, hal_pdir_t dir, hal_uint_t *ref, rtapi_uint def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_pin(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_u64(def), name.text)
               : -EINVAL;
}

int hal_param_new_uint(int compid, hal_pdir_t dir, hal_uint_t *ref, rtapi_uint def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_param(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_u64(def), name.text)
               : -EINVAL;
}

int hal_pin_new_si32(int compid, hal_pdir_t dir, hal_sint_t *ref, rtapi_s32 def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_pin(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_s32(def), name.text)
               : -EINVAL;
}

int hal_param_new_si32(int compid, hal_pdir_t dir, hal_sint_t *ref, rtapi_s32 def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_param(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_s32(def), name.text)
               : -EINVAL;
}

int hal_pin_new_ui32(int compid, hal_pdir_t dir, hal_uint_t *ref, rtapi_u32 def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_pin(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_u32(def), name.text)
               : -EINVAL;
}

int hal_param_new_ui32(int compid, hal_pdir_t dir, hal_uint_t *ref, rtapi_u32 def, const char *fmt, ...) {
    std::va_list args;
    va_start(args, fmt);
    const FormattedName name(fmt, args);
    va_end(args);
    const bool fitting = hal_pdir_is_param(dir) != 0;
    return name.good && fitting
               ? new_reference(compid, dir, reinterpret_cast<void **>(ref), Value::of_u32(def), name.text)
               : -EINVAL;
}

}  // extern "C"
