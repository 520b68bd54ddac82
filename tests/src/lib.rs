//! Whole-chain and accuracy tests live in `tests/`.
