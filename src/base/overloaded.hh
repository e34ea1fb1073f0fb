// SPDX-License-Identifier: GPL-2.0-or-later
// Visitors of closed variants: one handler per alternative, no default handler.
#pragma once

#include <concepts>
#include <type_traits>
#include <utility>
#include <variant>

namespace mw {

/// Combines handlers to one visitor: std::visit(Overloaded{[](const A &) {...}, [](const B &) {...}},
/// variant).
template <class... Handlers>
struct Overloaded : Handlers... {
    using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

/// For a handler of several named alternatives: [](const OneOf<A, B> auto &) {...}.
template <class Type, class... Types>
concept OneOf = (std::same_as<std::remove_cvref_t<Type>, Types> || ...);

template <class Type, class Variant>
inline constexpr bool IS_ALTERNATIVE = false;
template <class Type, class... Types>
inline constexpr bool IS_ALTERNATIVE<Type, std::variant<Types...>> = OneOf<Type, Types...>;
/// A class derived from a variant, with the base named Variant.
template <class Type, class Class>
    requires requires { typename Class::Variant; }
inline constexpr bool IS_ALTERNATIVE<Type, Class> = IS_ALTERNATIVE<Type, typename Class::Variant>;

template <class Type, class Variant>
concept AlternativeOf = IS_ALTERNATIVE<std::remove_cvref_t<Type>, Variant>;

}  // namespace mw
