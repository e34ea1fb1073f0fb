// SPDX-License-Identifier: GPL-2.0-or-later
// Sends the message EMC_IO_GENERIC over an NML channel, or receives it and prints it.
// usage: generic_output CONFIG send INDEX VALUE | generic_output CONFIG receive
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "base/diagnostics/sink.hh"
#include "clients/nml/bridge/channel.hh"
#include "clients/nml/config/config_file.hh"
#include "emc_io_generic.hh"

namespace {

using namespace mw;

int fail_with(const std::string &text) {
    std::fprintf(stderr, "generic_output: %s\n", text.c_str());
    return 1;
}

int send(nml::Channel &channel, int index, double value) {
    nml::CommandMessage<messages::EmcIoGeneric> command{{}, {index, value}};
    const auto written = channel.write(view(command));
    return written.has_value() ? 0 : fail_with(written.error().str());
}

/// Waits ten seconds at most.
int receive(nml::Channel &channel) {
    std::puts("ready");
    std::fflush(stdout);
    auto message = channel.wait(nml::Timeout{10});
    if (!message.has_value() || !message->has_value()) {
        return fail_with(message.has_value() ? "no message came" : message.error().str());
    }
    const auto *generic = (*message)->get<messages::EmcIoGeneric>();
    if (generic == nullptr) {
        return fail_with("another message came");
    }
    const auto allowed = messages::check(messages::object(*generic));
    if (!allowed.has_value()) {
        return fail_with(allowed.error().str());
    }
    std::printf("output %d = %g\n", generic->index, generic->value);
    return 0;
}

}  // namespace

int main(int count, char **words) {
    const bool isSending = count == 5 && std::strcmp(words[2], "send") == 0;
    if (!isSending && !(count == 3 && std::strcmp(words[2], "receive") == 0)) {
        std::fprintf(stderr, "usage: %s CONFIG send INDEX VALUE | %s CONFIG receive\n", words[0], words[0]);
        return 2;
    }
    diagnostics::Sink sink;
    const auto config = nml::load_config(words[1], sink);
    if (!config.has_value()) {
        return fail_with(config.error().str());
    }
    nml::Vocabulary vocabulary = nml::Vocabulary::standard();
    if (const auto added = vocabulary.add<messages::EmcIoGeneric>(nml::Base::COMMAND, "EMC_IO_GENERIC_TYPE");
        !added.has_value()) {
        return fail_with(added.error().str());
    }
    nml::LocalPlaces local;
    const std::string process = isSending ? "gui" : "io";
    auto channel = nml::Channel::open({*config, process, "generic-output", vocabulary, local}, "ioGeneric");
    if (!channel.has_value()) {
        return fail_with(channel.error().str());
    }
    return isSending ? send(*channel, std::atoi(words[3]), std::atof(words[4])) : receive(*channel);
}
