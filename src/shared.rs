//! Shared ownership.

/// A mesh or a texture that several objects, scenes and threads may share. On processors without
/// atomic operations (Cortex-M0) it stays within one thread.
#[cfg(target_has_atomic = "ptr")]
pub type Shared<T> = alloc::sync::Arc<T>;
/// A mesh or a texture that several objects and scenes may share, within one thread.
#[cfg(not(target_has_atomic = "ptr"))]
pub type Shared<T> = alloc::rc::Rc<T>;
