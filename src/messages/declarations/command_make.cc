// SPDX-License-Identifier: GPL-2.0-or-later
#include <utility>

#include "messages/declarations/command.hh"

namespace mw::messages {
namespace {

using Make = CommandVariant (*)(void *);

template <std::size_t... I>
constexpr auto all_makers(std::index_sequence<I...>) {
    return std::array<Make, sizeof...(I)>{[](void *message) {
        using Message = std::variant_alternative_t<I, CommandVariant>;
        return CommandVariant(std::in_place_index<I>, std::move(*static_cast<Message *>(message)));
    }...};
}
constexpr auto MAKERS = all_makers(std::make_index_sequence<std::variant_size_v<CommandVariant>>());

}  // namespace

Command::Command(std::size_t index, void *message) : CommandVariant(MAKERS[index](message)) {}

}  // namespace mw::messages
