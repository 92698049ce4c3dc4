#pragma once

/// \file
/// The configuration of Tight-Inclusion's own program with which it is compiled here: without its
/// sample queries.
