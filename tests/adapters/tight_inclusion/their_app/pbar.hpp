#pragma once

/// \file
/// The progress bar that Tight-Inclusion's own program includes, and uses only with its sample
/// queries.
