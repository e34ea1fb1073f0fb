// SPDX-License-Identifier: GPL-2.0-or-later
// Declaration of a message, written once beside its struct. Codecs, checks, lookups and the reference page
// read these tables at run time, so a message needs no separate code.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/geometry/pose.hh"
#include "messages/declarations/fixed_text.hh"

namespace mw::messages {

namespace unit {
inline constexpr const char *NONE = "";
inline constexpr const char *LENGTH = "machine units";
inline constexpr const char *JOINT = "machine units or degrees";
inline constexpr const char *POSE = "machine units, degrees";
inline constexpr const char *SPEED = "machine units/s";
inline constexpr const char *JOINT_SPEED = "machine units/s or degrees/s";
inline constexpr const char *ACCELERATION = "machine units/s2";
inline constexpr const char *JOINT_ACCELERATION = "machine units/s2 or degrees/s2";
inline constexpr const char *DEGREE = "degrees";
inline constexpr const char *RPM = "rev/min";
inline constexpr const char *REVOLUTIONS = "revolutions";
inline constexpr const char *SECOND = "s";
inline constexpr const char *MILLISECOND = "ms";
inline constexpr const char *NANOSECOND = "ns";
inline constexpr const char *FACTOR = "1.0 is 100 %";
}  // namespace unit

/// Both ends are included. For a text: its length in bytes.
struct Range {
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
};
inline constexpr Range ANY{};
inline constexpr Range AT_LEAST_0{0, std::numeric_limits<double>::infinity()};
constexpr Range range(double min, double max) {
    return {min, max};
}

/// A value of an enumeration and its name.
struct Name {
    std::int64_t value;
    const char *name;
};
template <class E>
constexpr Name named(E value, const char *name) {
    return {static_cast<std::int64_t>(value), name};
}
/// Specialised for each enumeration that a message uses: an array of Name.
template <class E>
inline constexpr std::nullptr_t NAMES = nullptr;

enum class Kind : std::uint8_t { BOOL, INTEGER, UNSIGNED, REAL, NAMED, TEXT, FIXED_TEXT, PARTS };

struct Declaration;

/// Access to the std::vector of a field without its type.
struct ListAccess {
    std::size_t (*size)(const void *list);
    void (*resize)(void *list, std::size_t size);
    void *(*element)(void *list, std::size_t index);
};

struct Type {
    Kind kind = Kind::BOOL;
    std::uint8_t bytes = 0;  ///< size of a number
    bool isArray = false;    ///< `count` elements, `stride` bytes apart
    std::uint32_t count = 1;
    std::uint32_t stride = 0;
    std::uint32_t capacity = 0;          ///< maximum length of a fixed text
    std::span<const Name> names{};       ///< names of an enumeration
    const Declaration *parts = nullptr;  ///< declaration of a struct
    const ListAccess *list = nullptr;    ///< list of any number of elements, up to the end of the range
};

enum class Presence : std::uint8_t { REQUIRED, OPTIONAL };

struct Field {
    const char *name;
    Type type;
    const char *doc;
    const char *unit;
    Range range;
    void *(*at)(void *object);
    Presence presence = Presence::REQUIRED;  ///< an optional field keeps its default if JSON omits it
};

struct Declaration {
    const char *name;
    int number;  ///< 0: only a part of other messages
    const char *doc;
    std::span<const Field> fields;
};

template <std::size_t N>
struct Declared {
    const char *name;
    int number;
    const char *doc;
    std::array<Field, N> fields;
};
/// Specialised for each struct by declare().
template <class T>
inline constexpr std::nullptr_t DECLARED = nullptr;

template <class T>
inline constexpr Declaration DECLARATION{DECLARED<T>.name, DECLARED<T>.number, DECLARED<T>.doc,
                                         std::span<const Field>(DECLARED<T>.fields)};

/// LinuxCNC's messages keep their numbers; numbers of Millwright's own messages begin here.
inline constexpr int FIRST_OWN_NUMBER = 3001;

template <class... F>
constexpr auto declare(const char *name, int number, const char *doc, F... fields) {
    return Declared<sizeof...(F)>{name, number, doc, std::array<Field, sizeof...(F)>{fields...}};
}

namespace detail {

template <class T>
inline constexpr bool isDeclared = !std::is_same_v<std::remove_cv_t<decltype(DECLARED<T>)>, std::nullptr_t>;

template <class T>
inline constexpr ListAccess LIST_OF{
    [](const void *list) { return static_cast<const std::vector<T> *>(list)->size(); },
    [](void *list, std::size_t size) { static_cast<std::vector<T> *>(list)->resize(size); },
    [](void *list, std::size_t index) -> void * { return &(*static_cast<std::vector<T> *>(list))[index]; }};

template <class T>
struct TypeOf {
    static constexpr Type get() {
        Type type;
        type.bytes = static_cast<std::uint8_t>(sizeof(T) <= 8 ? sizeof(T) : 0);
        type.stride = sizeof(T);
        if constexpr (std::is_same_v<T, bool>) {
            type.kind = Kind::BOOL;
        } else if constexpr (std::is_enum_v<T>) {
            type.kind = Kind::NAMED;
            type.names = std::span<const Name>(NAMES<T>);
        } else if constexpr (std::is_floating_point_v<T>) {
            static_assert(sizeof(T) == 8);
            type.kind = Kind::REAL;
        } else if constexpr (std::is_integral_v<T>) {
            type.kind = std::is_signed_v<T> ? Kind::INTEGER : Kind::UNSIGNED;
        } else if constexpr (std::is_same_v<T, std::string>) {
            type.kind = Kind::TEXT;
        } else {
            static_assert(isDeclared<T>, "a field's struct is declared before the message that has it");
            type.kind = Kind::PARTS;
            type.parts = &DECLARATION<T>;
        }
        return type;
    }
};
template <std::size_t N>
struct TypeOf<FixedText<N>> {
    static constexpr Type get() {
        Type type;
        type.kind = Kind::FIXED_TEXT;
        type.capacity = N;
        type.stride = sizeof(FixedText<N>);
        return type;
    }
};
template <class T, std::size_t N>
struct TypeOf<std::array<T, N>> {
    static constexpr Type get() {
        Type type = TypeOf<T>::get();
        static_assert(N > 0);
        type.isArray = true;
        type.count = N;
        type.stride = sizeof(T);
        return type;
    }
};
template <>
struct TypeOf<geometry::Pose> : TypeOf<std::array<double, geometry::AXIS_COUNT>> {};
template <class T>
struct TypeOf<std::vector<T>> {
    static constexpr Type get() {
        Type type = TypeOf<T>::get();
        type.list = &LIST_OF<T>;
        return type;
    }
};

template <class C, class T>
T member_type(T C::*);
template <class C, class T>
C object_type(T C::*);

}  // namespace detail

template <auto MEMBER>
constexpr Field field(const char *name, const char *doc, const char *unit = unit::NONE, Range range = ANY) {
    using Object = decltype(detail::object_type(MEMBER));
    using Member = decltype(detail::member_type(MEMBER));
    return {name,  detail::TypeOf<Member>::get(),
            doc,   unit,
            range, [](void *object) -> void * { return &(static_cast<Object *>(object)->*MEMBER); }};
}
constexpr Field optional(Field field) {
    field.presence = Presence::OPTIONAL;
    return field;
}

/// A struct with its declaration, without its type.
struct Object {
    const Declaration *declaration;
    void *data;
};
struct ConstObject {
    const Declaration *declaration;
    const void *data;

    ConstObject(const Declaration *what, const void *where) : declaration(what), data(where) {}
    ConstObject(const Object &object) : declaration(object.declaration), data(object.data) {}
};
template <class T>
Object object(T &value) {
    return {&DECLARATION<T>, &value};
}
template <class T>
ConstObject object(const T &value) {
    return {&DECLARATION<T>, &value};
}

}  // namespace mw::messages
