// SPDX-License-Identifier: GPL-2.0-or-later
// A step written as a function that waits for cycles of the machine: a coroutine that is resumed once a
// cycle.
#pragma once

#include <coroutine>
#include <exception>
#include <optional>
#include <utility>

namespace mw::commissioning {

namespace detail {

struct FlowPromiseBase {
    std::coroutine_handle<> caller;

    struct Final {
        bool await_ready() noexcept { return false; }
        template <class Promise>
        std::coroutine_handle<> await_suspend(std::coroutine_handle<Promise> done) noexcept {
            const std::coroutine_handle<> resumed = done.promise().caller;
            return resumed ? resumed : std::noop_coroutine();
        }
        void await_resume() noexcept {}
    };
    std::suspend_always initial_suspend() noexcept { return {}; }
    Final final_suspend() noexcept { return {}; }
    void unhandled_exception() { std::terminate(); }
};

template <class T>
struct FlowPromise : FlowPromiseBase {
    std::optional<T> value;
    void return_value(T result) { value = std::move(result); }
    T take() { return std::move(*value); }
};
template <>
struct FlowPromise<void> : FlowPromiseBase {
    void return_void() {}
    void take() {}
};

}  // namespace detail

/// Starts when it is awaited, or when start() is called for the outermost flow. Destroying it ends it at the
/// cycle for which it waits, with the destructors of its local variables.
template <class T = void>
class [[nodiscard]] Flow {
  public:
    struct promise_type : detail::FlowPromise<T> {
        Flow get_return_object() { return Flow(std::coroutine_handle<promise_type>::from_promise(*this)); }
    };

    Flow(Flow &&other) noexcept : handle_(std::exchange(other.handle_, {})) {}
    Flow(const Flow &) = delete;
    Flow &operator=(const Flow &) = delete;
    Flow &operator=(Flow &&other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Flow() {
        if (handle_) {
            handle_.destroy();
        }
    }

    bool isDone() const { return handle_.done(); }
    std::coroutine_handle<> handle() const { return handle_; }

    bool await_ready() const noexcept { return false; }
    std::coroutine_handle<> await_suspend(std::coroutine_handle<> caller) noexcept {
        handle_.promise().caller = caller;
        return handle_;
    }
    T await_resume() { return handle_.promise().take(); }

  private:
    explicit Flow(std::coroutine_handle<promise_type> handle) : handle_(handle) {}
    std::coroutine_handle<promise_type> handle_;
};

}  // namespace mw::commissioning
