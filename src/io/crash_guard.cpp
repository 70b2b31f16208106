// SPDX-License-Identifier: BSD-3-Clause
#include "io/crash_guard.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "core/errors.hpp"
#include "parallel/mpi.hpp"

namespace carrom {

namespace {

const char* path_being_read = "";

/// Calls nothing that a handler of signals may not call, but for MPI's end.
extern "C" void end_for_damage(int) {
    static std::array<char, 4400> text; // a path has 4096 bytes at most
    std::size_t length = 0;
    for (const std::string_view part :
         {std::string_view("carrom: "), std::string_view(path_being_read),
          std::string_view(": is damaged: HDF5 has crashed on it\n")}) {
        const std::size_t n = std::min(part.size(), text.size() - length);
        std::memcpy(text.data() + length, part.data(), n);
        length += n;
    }
    abort_from_signal({text.data(), length}, static_cast<int>(ExitCode::bad_input));
}

/// A stack that has run over is one of the ways to crash.
void choose_another_stack() {
    static std::array<std::byte, 1 << 18> room;
    stack_t stack{};
    stack.ss_sp = room.data();
    stack.ss_size = room.size();
    ::sigaltstack(&stack, nullptr);
}

} // namespace

CrashGuard::CrashGuard(const std::string& path) : outer_path_(path_being_read) {
    static const bool has_stack = (choose_another_stack(), true);
    static_cast<void>(has_stack);
    path_being_read = path.c_str();
    struct sigaction action{};
    action.sa_handler = end_for_damage;
    action.sa_flags = static_cast<int>(SA_ONSTACK | SA_RESETHAND);
    for (std::size_t k = 0; k < signals.size(); ++k)
        ::sigaction(signals[k], &action, &outer_actions_[k]);
}

CrashGuard::~CrashGuard() {
    path_being_read = outer_path_;
    for (std::size_t k = 0; k < signals.size(); ++k)
        ::sigaction(signals[k], &outer_actions_[k], nullptr);
}

} // namespace carrom
