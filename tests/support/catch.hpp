// SPDX-License-Identifier: BSD-3-Clause
// Includes Catch2, whichever version is installed: 2.13 (Debian 12) or 3 (Debian 13, Ubuntu 24.04).
//
// Version 3 has several headers; those that tests use are included here. A main defines
// CARROM_CATCH_MAIN before it includes this. It gets Catch2's session, the base class of listeners,
// and the result type of their `assertionEnded`.
#pragma once

#if __has_include(<catch2/catch_test_macros.hpp>)

#include <catch2/catch_approx.hpp>
#include <catch2/catch_message.hpp>
#include <catch2/catch_test_macros.hpp>
#ifdef CARROM_CATCH_MAIN
#include <catch2/catch_session.hpp>
#include <catch2/catch_test_case_info.hpp>
#include <catch2/reporters/catch_reporter_event_listener.hpp>
#include <catch2/reporters/catch_reporter_registrars.hpp>

using TestListener = Catch::EventListenerBase;
using AfterAssertion = void;
#endif

using Catch::Approx; // version 2 has this already

#else

#ifdef CARROM_CATCH_MAIN
#define CATCH_CONFIG_RUNNER
#endif
#include <catch2/catch.hpp>
#ifdef CARROM_CATCH_MAIN
using TestListener = Catch::TestEventListenerBase;
using AfterAssertion = bool; // whether to forget the assertion's messages
#endif

#endif
