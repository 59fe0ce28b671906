# SPDX-License-Identifier: GPL-3.0-or-later
# Changes Embree's task scheduler where it runs out of memory. Whoever takes part in a build allocates a queue of tasks
# after it was counted in. Where that fails, a worker's exception leaves its thread and ends the process, and a caller's
# leaves the count one too high, so that its next build waits for ever.

# Replaces what stands once in a file.
function(replace_once file old new)
    file(READ ${file} text)
    string(FIND "${text}" "${old}" first)
    string(FIND "${text}" "${old}" last REVERSE)
    if(first EQUAL -1 OR NOT first EQUAL last)
        message(FATAL_ERROR "Embree's ${file} does not have this once:\n${old}")
    endif()
    string(REPLACE "${old}" "${new}" text "${text}")
    file(WRITE ${file} "${text}")
endfunction()

# A thread without a queue does nothing, and leaves with the others.
set(tasking ${source}/common/tasking)
replace_once(${tasking}/taskschedulerinternal.cpp
"    std::unique_ptr<Thread> mthread(new Thread(threadIndex,this)); // too large for stack allocation
    Thread& thread = *mthread;
    threadLocal[threadIndex].store(&thread);"
"    std::unique_ptr<Thread> mthread;
    try {
      mthread.reset(new Thread(threadIndex,this)); // too large for stack allocation
    } catch (const std::bad_alloc&) {
      while (anyTasksRunning) yield();
      threadCounter--;
      while (threadCounter > 0) yield();
      return cancellingException;
    }
    Thread& thread = *mthread;
    threadLocal[threadIndex].store(&thread);")

# A caller is counted in when it has its queue.
replace_once(${tasking}/taskschedulerinternal.h
"      size_t threadIndex = allocThreadIndex();
      std::unique_ptr<Thread> mthread(new Thread(threadIndex,this)); // too large for stack allocation
      Thread& thread = *mthread;"
"      std::unique_ptr<Thread> mthread(new Thread(0,this)); // too large for stack allocation
      const size_t threadIndex = allocThreadIndex();
      Thread& thread = *mthread;
      thread.threadIndex = threadIndex;")
