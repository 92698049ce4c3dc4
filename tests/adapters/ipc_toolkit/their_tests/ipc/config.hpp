#pragma once

/// \file
/// The configuration of the IPC Toolkit in which its tests are compiled here: without options.
