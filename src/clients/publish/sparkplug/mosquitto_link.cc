// SPDX-License-Identifier: GPL-2.0-or-later
// Implemented with libmosquitto, which only this file includes.
#include "clients/publish/sparkplug/mosquitto_link.hh"

#include <mosquitto.h>

#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include <fmt/format.h>

namespace mw::publish {
namespace {

/// Folder of the system's certificates.
constexpr const char *SYSTEM_AUTHORITIES = "/etc/ssl/certs";

/// The library must be initialised once in a process.
struct Library {
    Library() { mosquitto_lib_init(); }
    ~Library() { mosquitto_lib_cleanup(); }
    Library(const Library &) = delete;
    Library &operator=(const Library &) = delete;
};

std::string text_of(int code) {
    return code == MOSQ_ERR_ERRNO ? std::strerror(errno) : mosquitto_strerror(code);
}

const char *or_null(const std::string &text) {
    return text.empty() ? nullptr : text.c_str();
}

Result<> set_tls(mosquitto *client, const LinkSettings &settings) {
    const bool isSystem = settings.authorities.empty();
    const int set =
        mosquitto_tls_set(client, or_null(settings.authorities), isSystem ? SYSTEM_AUTHORITIES : nullptr,
                          or_null(settings.certificate), or_null(settings.key), nullptr);
    if (set != MOSQ_ERR_SUCCESS) {
        return fail(fmt::format("cannot use the certificates for TLS: {}", text_of(set)));
    }
    constexpr int VERIFY_PEER = 1;
    const int options = mosquitto_tls_opts_set(client, VERIFY_PEER, nullptr, nullptr);
    return options == MOSQ_ERR_SUCCESS ? Result<>{} : fail("cannot set the TLS options: " + text_of(options));
}

std::deque<LinkEvent> &events_of(void *object) {
    return *static_cast<std::deque<LinkEvent> *>(object);
}

void on_connect(mosquitto *, void *object, int code) {
    if (code == 0) {
        events_of(object).emplace_back(Connected{});
    } else {
        events_of(object).emplace_back(Disconnected{
            fmt::format("The broker rejects the connection: {}.", mosquitto_connack_string(code))});
    }
}

void on_message(mosquitto *, void *object, const mosquitto_message *message) {
    events_of(object).emplace_back(Publication{message->topic,
                                               std::string(static_cast<const char *>(message->payload),
                                                           static_cast<std::size_t>(message->payloadlen)),
                                               message->qos, message->retain});
}

void on_unsubscribe(mosquitto *, void *object, int number) {
    events_of(object).emplace_back(BarrierPassed{number});
}

}  // namespace

MosquittoLink::MosquittoLink(LinkSettings settings) : settings_(std::move(settings)) {
    static const Library LIBRARY;
}

MosquittoLink::~MosquittoLink() {
    end();
}

void MosquittoLink::end() {
    if (client_ != nullptr) {
        mosquitto_destroy(std::exchange(client_, nullptr));
    }
}

void MosquittoLink::lost(const std::string &why) {
    end();
    events_.emplace_back(Disconnected{why});
}

Result<> MosquittoLink::begin(std::size_t broker, const Publication &will) {
    end();
    events_.clear();
    client_ = mosquitto_new(settings_.client_id.c_str(), true, &events_);
    if (client_ == nullptr) {
        return fail(fmt::format("cannot create an MQTT client: {}", std::strerror(errno)));
    }
    mosquitto_connect_callback_set(client_, on_connect);
    mosquitto_message_callback_set(client_, on_message);
    mosquitto_unsubscribe_callback_set(client_, on_unsubscribe);
    mosquitto_int_option(client_, MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V311);
    mosquitto_int_option(client_, MOSQ_OPT_TCP_NODELAY, 1);
    int code = MOSQ_ERR_SUCCESS;
    if (!will.topic.empty()) {
        code = mosquitto_will_set(client_, will.topic.c_str(), static_cast<int>(will.payload.size()),
                                  will.payload.data(), will.qos, will.isRetained);
    }
    if (code == MOSQ_ERR_SUCCESS && !settings_.user.empty()) {
        code = mosquitto_username_pw_set(client_, settings_.user.c_str(), or_null(settings_.password));
    }
    if (code != MOSQ_ERR_SUCCESS) {
        return fail("cannot set up the MQTT client: " + text_of(code));
    }
    if (settings_.isTls) {
        if (auto set = set_tls(client_, settings_); !set.has_value()) {
            return set;
        }
    }
    const BrokerAddress &address = settings_.brokers[broker];
    code = mosquitto_connect_async(client_, address.host.c_str(), address.port, settings_.keepalive_s);
    if (code != MOSQ_ERR_SUCCESS) {
        return fail(
            fmt::format("cannot connect to the broker {}:{}: {}", address.host, address.port, text_of(code)));
    }
    return {};
}

void MosquittoLink::connect(std::size_t broker, const Publication &will) {
    if (const auto begun = begin(broker, will); !begun.has_value()) {
        lost(begun.error().message);
    }
}

void MosquittoLink::wait(std::chrono::milliseconds time) {
    if (client_ == nullptr) {
        std::this_thread::sleep_for(time);
        return;
    }
    const int code = mosquitto_loop(client_, static_cast<int>(time.count()), 1);
    if (code != MOSQ_ERR_SUCCESS) {
        const bool isRejected = !events_.empty() && std::holds_alternative<Disconnected>(events_.back());
        if (isRejected) {
            end();
        } else {
            lost(fmt::format("The connection to the broker is lost: {}.", text_of(code)));
        }
    }
}

void MosquittoLink::subscribe(const std::string &topic) {
    if (client_ != nullptr) {
        mosquitto_subscribe(client_, nullptr, topic.c_str(), 1);
    }
}

void MosquittoLink::publish(const Publication &message) {
    if (client_ != nullptr) {
        mosquitto_publish(client_, nullptr, message.topic.c_str(), static_cast<int>(message.payload.size()),
                          message.payload.data(), message.qos, message.isRetained);
    }
}

int MosquittoLink::barrier() {
    // The broker answers in the order in which it receives packets, also to an unsubscription without a
    // subscription.
    int number = 0;
    if (client_ != nullptr) {
        mosquitto_unsubscribe(client_, &number, settings_.not_delivered_topic.c_str());
    }
    return number;
}

void MosquittoLink::disconnect() {
    if (client_ != nullptr) {
        mosquitto_disconnect(client_);
        // Writes as much as the kernel accepts; does not wait for a broker that hangs.
        mosquitto_loop_write(client_, 1);
        end();
    }
    events_.clear();
}

void MosquittoLink::drop() {
    end();
    events_.clear();
}

std::optional<LinkEvent> MosquittoLink::next_event() {
    if (events_.empty()) {
        return std::nullopt;
    }
    LinkEvent event = std::move(events_.front());
    events_.pop_front();
    return event;
}

}  // namespace mw::publish
