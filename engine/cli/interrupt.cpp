// SPDX-License-Identifier: GPL-3.0-or-later
#include "interrupt.h"

#include <csignal>

namespace glimmer {
namespace {

volatile std::sig_atomic_t flag = 0;

extern "C" void set_flag(int) {
    flag = 1;
}

} // namespace

void catch_interrupts() {
    struct sigaction action = {};
    action.sa_handler = set_flag;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    // A file that grows past the limit is an error of the write, not the end of the process.
    std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() {
    return flag != 0;
}

} // namespace glimmer
