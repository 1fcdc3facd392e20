//! Shared ownership.

/// A mesh or a texture that several objects, scenes and threads may share. On processors without
/// atomic operations (Cortex-M0) it stays within one thread.
#[cfg(target_has_atomic = "ptr")]
pub type Shared<T> = alloc::sync::Arc<T>;
/// A mesh or a texture that several objects and scenes may share, within one thread.
#[cfg(not(target_has_atomic = "ptr"))]
pub type Shared<T> = alloc::rc::Rc<T>;

/// A reference to a [`Shared`] that does not keep it alive.
#[cfg(target_has_atomic = "ptr")]
pub(crate) type WeakShared<T> = alloc::sync::Weak<T>;
/// A reference to a [`Shared`] that does not keep it alive.
#[cfg(not(target_has_atomic = "ptr"))]
pub(crate) type WeakShared<T> = alloc::rc::Weak<T>;
