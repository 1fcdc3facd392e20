//! Every loop over pixels against its definition.
