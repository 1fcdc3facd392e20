//! Work that the picture does not wait for: a thread that is asked, and the last answer that it gave.
//!
//! It is handed over one question at a time. A newer one takes the place of one that nobody has begun with, so that the
//! thread never falls behind by more than the one it is at, however fast questions come. An answer may come in several
//! stages, each better than the one before; the thread can ask whether a newer question makes the rest needless.

use std::io;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

/// A thread at work. Once this is dropped the thread ends as soon as it is done with what it has begun; nobody
/// waits for that.
pub(super) struct Background<Question, Answer> {
    desk: Arc<Desk<Question, Answer>>,
}

/// Desk for questions and answers. It is locked for moving one, never while one is worked on.
pub(super) struct Desk<Question, Answer> {
    papers: Mutex<Papers<Question, Answer>>,
    asked: Condvar,
}

struct Papers<Question, Answer> {
    question: Option<Question>,
    answer: Option<Answer>,
    closed: bool,
}

impl<Question, Answer> Desk<Question, Answer> {
    /// A thread that panicked leaves whole papers behind: nothing but moves happens under the lock.
    fn papers(&self) -> MutexGuard<'_, Papers<Question, Answer>> {
        self.papers.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for a question. `None` when there will be no more.
    fn next(&self) -> Option<Question> {
        let idle = |papers: &mut Papers<Question, Answer>| papers.question.is_none() && !papers.closed;
        let waited = self.asked.wait_while(self.papers(), idle);
        let mut papers = waited.unwrap_or_else(PoisonError::into_inner);
        if papers.closed { None } else { papers.question.take() }
    }

    /// Gives an answer, in place of one that nobody has taken.
    pub(super) fn give(&self, answer: Answer) {
        let before = self.papers().answer.replace(answer);
        // Not under the lock: freeing a picture takes its time.
        drop(before);
    }

    /// Returns whether there is a newer question, or nobody who waits for an answer.
    pub(super) fn is_overtaken(&self) -> bool {
        let papers = self.papers();
        papers.question.is_some() || papers.closed
    }
}

impl<Question: Send + 'static, Answer: Send + 'static> Background<Question, Answer> {
    /// Starts the thread, which gives its answers to the desk. There may be none to be had.
    pub(super) fn start(
        name: &str,
        mut work: impl FnMut(Question, &Desk<Question, Answer>) + Send + 'static,
    ) -> io::Result<Background<Question, Answer>> {
        let papers = Papers { question: None, answer: None, closed: false };
        let desk = Arc::new(Desk { papers: Mutex::new(papers), asked: Condvar::new() });
        let own = Arc::clone(&desk);
        thread::Builder::new().name(name.to_string()).spawn(move || {
            while let Some(question) = own.next() {
                work(question, &own);
            }
        })?;
        Ok(Background { desk })
    }

    /// Asks, in place of what was asked before and has not been begun with.
    pub(super) fn ask(&self, question: Question) {
        let before = self.desk.papers().question.replace(question);
        self.desk.asked.notify_one();
        // Not under the lock: freeing a scene takes its time.
        drop(before);
    }

    /// The last answer, once.
    pub(super) fn answer(&self) -> Option<Answer> {
        self.desk.papers().answer.take()
    }
}

impl<Question, Answer> Drop for Background<Question, Answer> {
    fn drop(&mut self) {
        self.desk.papers().closed = true;
        self.desk.asked.notify_one();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::{Receiver, Sender, channel};
    use std::time::Duration;

    /// Longer than any thread here takes, even on a busy machine.
    const LONG: Duration = Duration::from_secs(60);

    /// A thread that says what it begins with, and does not finish before it is let go on.
    fn held_up() -> (Background<u32, u32>, Receiver<u32>, Sender<()>) {
        let (begins, begun) = channel();
        let (go_on, gone_on) = channel::<()>();
        let work = move |question, desk: &Desk<u32, u32>| {
            begins.send(question).expect("the test listens");
            // A test that is over lets it go on too.
            let _ = gone_on.recv();
            desk.give(question * 10 + u32::from(desk.is_overtaken()));
        };
        (Background::start("test", work).expect("a thread"), begun, go_on)
    }

    fn wait_for(background: &Background<u32, u32>) -> u32 {
        loop {
            if let Some(answer) = background.answer() {
                return answer;
            }
            thread::yield_now();
        }
    }

    #[test]
    fn of_what_is_asked_while_it_works_the_latest_wins() {
        let (background, begun, go_on) = held_up();
        background.ask(1);
        assert_eq!(begun.recv_timeout(LONG), Ok(1));
        // Nobody waits: all of these return while the first is held up.
        (2..=1000).for_each(|question| background.ask(question));
        assert_eq!(background.answer(), None);
        go_on.send(()).expect("it works");
        // It knew that it was overtaken.
        assert_eq!(wait_for(&background), 11);
        assert_eq!(begun.recv_timeout(LONG), Ok(1000));
        go_on.send(()).expect("it works");
        assert_eq!(wait_for(&background), 10_000);
        assert_eq!(background.answer(), None);
    }

    #[test]
    fn its_thread_ends_when_it_is_dropped() {
        // Idle.
        let (background, begun, _go_on) = held_up();
        drop(background);
        assert!(begun.recv_timeout(LONG).is_err());
        // At work, with another question waiting that is not begun with.
        let (background, begun, go_on) = held_up();
        background.ask(1);
        assert_eq!(begun.recv_timeout(LONG), Ok(1));
        background.ask(2);
        drop(background);
        go_on.send(()).expect("it works");
        assert!(begun.recv_timeout(LONG).is_err());
    }
}
