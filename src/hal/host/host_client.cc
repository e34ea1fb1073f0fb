// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/host/host_client.hh"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "base/own_place.hh"
#include "hal/host/message.hh"
#include "runtime/process.hh"

namespace mw::hal {
namespace {

constexpr int END_TIMEOUT_MS = 15000;
constexpr int CLOSING_MS = 200;

Result<int> connect_to(const std::string &instance) {
    const auto path = socket_path(instance);
    if (!path) {
        return std::unexpected(path.error());
    }
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path->size() >= sizeof address.sun_path) {
        return fail("the path of the socket is too long: " + *path);
    }
    std::memcpy(address.sun_path, path->data(), path->size());
    const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd < 0 || ::connect(fd, reinterpret_cast<const sockaddr *>(&address), sizeof address) != 0) {
        if (fd >= 0) {
            ::close(fd);
        }
        return fail("no realtime process of instance '" + instance + "' is alive", {},
                    "start it with halrun");
    }
    return fd;
}

/// millwright-rt beside this program or in ../bin; otherwise from PATH.
std::string server_program() {
    const std::string folder = program_folder();
    for (const std::string &candidate : {folder + "/millwright-rt", folder + "/../bin/millwright-rt"}) {
        if (::access(candidate.c_str(), X_OK) == 0) {
            return candidate;
        }
    }
    return "millwright-rt";
}

/// In the forked child: becomes the server, detached from this process. Only async-signal-safe calls.
[[noreturn]] void become_server(char *const argv[], int ready, int starter, int messages) {
    if (::fork() != 0) {
        ::_exit(0);
    }
    ::setsid();
    const int null = ::open("/dev/null", O_RDWR);
    ::dup2(null, STDIN_FILENO);
    if (messages >= 0) {
        ::dup2(messages, STDERR_FILENO);
    }
    // rtapi_print writes to the starter's standard output. A server that outlives the starter must not keep
    // the starter's pipe open.
    if (messages >= 0 || starter < 0) {
        ::dup2(STDERR_FILENO, STDOUT_FILENO);
    }
    ::fcntl(ready, F_SETFD, 0);
    if (starter >= 0) {
        ::fcntl(starter, F_SETFD, 0);
    }
    ::execvp(argv[0], argv);
    const char text[] = "cannot run millwright-rt";
    (void)!::write(ready, text, sizeof text - 1);
    ::_exit(127);
}

/// Reads the new server's report: empty when it is ready, else the reason.
std::string read_all(int fd) {
    std::string text;
    char bytes[512];
    while (true) {
        const ssize_t got = ::read(fd, bytes, sizeof bytes);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            return text;
        }
        text.append(bytes, static_cast<std::size_t>(got));
    }
}

}  // namespace

struct HostClient::Impl {
    std::string instance;
    int fd = -1;
    int pid = 0;
    int process = -1;  ///< pidfd of the realtime process
    std::unique_ptr<Instance> hal;

    ~Impl() {
        for (const int one : {fd, process}) {
            if (one >= 0) {
                ::close(one);
            }
        }
    }
    /// True when the process ends within `timeout_ms`.
    bool hasEnded(int timeout_ms) const {
        pollfd end{process, POLLIN, 0};
        return process < 0 || ::poll(&end, 1, timeout_ms) > 0;
    }
};

HostClient::HostClient(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

HostClient::~HostClient() = default;

Result<std::unique_ptr<HostClient>> HostClient::connect(const std::string &instance) {
    auto impl = std::make_unique<Impl>();
    impl->instance = instance;
    const auto fd = connect_to(instance);
    if (!fd) {
        return std::unexpected(fd.error());
    }
    impl->fd = *fd;
    auto client = std::unique_ptr<HostClient>(new HostClient(std::move(impl)));
    const auto hello = client->ask({"hello"});
    if (!hello || hello->empty()) {
        return fail("the realtime process of instance '" + instance + "' does not answer");
    }
    client->impl_->pid = std::atoi(hello->front().c_str());
    client->impl_->process = static_cast<int>(::syscall(SYS_pidfd_open, client->impl_->pid, 0));
    auto hal = Instance::attach(instance);
    if (!hal) {
        return std::unexpected(hal.error());
    }
    client->impl_->hal = std::move(*hal);
    return client;
}

Result<std::unique_ptr<HostClient>> HostClient::start(const std::string &instance, MessagesTo messages_to,
                                                      Lifetime lifetime) {
    if (isHostAlive(instance)) {
        return fail("a realtime process of instance '" + instance + "' is already running", {},
                    "end it with 'halrun -U', or choose another name in MILLWRIGHT_INSTANCE");
    }
    int ready[2];
    if (::pipe2(ready, O_CLOEXEC) != 0) {
        return fail(std::string("cannot create a pipe: ") + std::strerror(errno));
    }
    int messages = -1;
    if (messages_to == MessagesTo::FILE) {
        const auto folder = runtime::runtime_folder();
        if (folder) {
            messages = ::open((*folder + '/' + instance + ".log").c_str(),
                              O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600);
        }
    }
    // With this descriptor the kernel reports the end of the starter at any time.
    const int starter =
        lifetime == Lifetime::STARTER ? static_cast<int>(::syscall(SYS_pidfd_open, ::getpid(), 0)) : -1;
    // Everything is prepared before the fork: the child of a process with threads may not allocate memory.
    std::vector<std::string> words = {server_program(), "--instance", instance, "--ready-fd",
                                      std::to_string(ready[1])};
    if (starter >= 0) {
        words.insert(words.end(), {"--starter-fd", std::to_string(starter)});
    }
    std::vector<char *> argv;
    for (std::string &word : words) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
        become_server(argv.data(), ready[1], starter, messages);
    }
    ::close(ready[1]);
    for (const int fd : {messages, starter}) {
        if (fd >= 0) {
            ::close(fd);
        }
    }
    if (child > 0) {
        while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
        }
    }
    const std::string said = read_all(ready[0]);
    ::close(ready[0]);
    if (child < 0 || said != "ready") {
        return fail("the realtime process does not start: " + (said.empty() ? "it ended at once" : said));
    }
    return connect(instance);
}

Instance &HostClient::hal() noexcept {
    return *impl_->hal;
}

int HostClient::pid() const noexcept {
    return impl_->pid;
}

/// The texts after "ok"; other answers are errors.
Result<std::vector<std::string>> HostClient::ask(const std::vector<std::string> &request) {
    auto answer = isSent(impl_->fd, request)
                      ? receive(impl_->fd)
                      : Result<std::vector<std::string>>(fail("it does not accept connections"));
    if (!answer) {
        // The server closes its socket shortly before its process ends.
        static_cast<void>(impl_->hasEnded(CLOSING_MS));
        errno = EPIPE;
        const auto end = impl_->hal == nullptr ? std::nullopt : death();
        return std::unexpected(end.value_or(
            Error{fmt::format("the realtime process of instance '{}' has ended", impl_->instance), {}, {}}));
    }
    if (answer->empty() || (*answer)[0] != "ok") {
        errno = EINVAL;
        const std::string hint = answer->size() > 2 ? (*answer)[2] : std::string();
        return fail(answer->size() > 1 ? (*answer)[1] : "the realtime process did not answer", {}, hint);
    }
    answer->erase(answer->begin());
    return answer;
}

Result<> HostClient::load_realtime(const std::string &name, const std::vector<std::string> &args) {
    std::vector<std::string> request = {"load", name};
    request.insert(request.end(), args.begin(), args.end());
    const auto answer = ask(request);
    return answer ? Result<>{} : std::unexpected(answer.error());
}

Result<> HostClient::unload_realtime(const std::string &name) {
    const auto answer = ask({"unload", name});
    return answer ? Result<>{} : std::unexpected(answer.error());
}

Result<std::vector<std::string>> HostClient::modules() {
    return ask({"modules"});
}

Result<bool> HostClient::isModuleLoaded(const std::string &name) {
    const auto names = modules();
    if (!names) {
        return std::unexpected(names.error());
    }
    for (const std::string &module : *names) {
        if (module == name) {
            return true;
        }
    }
    return false;
}

Result<> HostClient::set_log_level(runtime::LogLevel level) {
    impl_->hal->log().set_level(level);
    const auto answer = ask({"debug", std::to_string(static_cast<int>(level))});
    return answer ? Result<>{} : std::unexpected(answer.error());
}

Result<> HostClient::control() {
    const auto answer = ask({"control"});
    return answer ? Result<>{} : std::unexpected(answer.error());
}

Result<> HostClient::shut_down() {
    if (!impl_->hasEnded(0)) {
        // The server may end by itself meanwhile, with the same effect.
        static_cast<void>(ask({"end"}));
    }
    if (!impl_->hasEnded(END_TIMEOUT_MS)) {
        return fail("the realtime process " + std::to_string(impl_->pid) + " does not end");
    }
    remove_leftovers(impl_->instance);
    return {};
}

std::optional<Error> HostClient::death() const {
    const bool ended = impl_->hasEnded(0);
    const auto how = impl_->hal->host_status().end_reason();
    if (!ended && !how) {
        return std::nullopt;
    }
    return Error{fmt::format("the realtime process {} of instance '{}' has ended: {}", impl_->pid,
                             impl_->instance, how.value_or("it was killed, or ended without a message")),
                 {},
                 {}};
}

bool isHostAlive(const std::string &instance) {
    return isLockTaken(instance);
}

}  // namespace mw::hal
