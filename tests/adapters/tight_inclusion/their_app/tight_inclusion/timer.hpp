#pragma once

/// \file
/// The stopwatch that Tight-Inclusion's own program includes, and uses only with its sample
/// queries.
