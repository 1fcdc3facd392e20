//! Work that the picture does not wait for: a thread that answers questions, and its latest answer.
//!
//! Questions are handed over one at a time. A newer question replaces one that has not been started, so the thread
//! never falls behind by more than the one it is working on, however fast they come. An answer may come in several
//! stages, each better than the one before; the thread can check whether a newer question makes the rest pointless.

use std::io;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

/// A background thread. Once this is dropped, the thread ends as soon as it has finished the question it is working on;
/// nobody waits for that.
pub(super) struct Background<Question, Answer> {
    desk: Arc<Desk<Question, Answer>>,
}

/// Desk for questions and answers. It is locked only to move one, never while one is being worked on.
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
    /// Locks the papers. They are intact even if a thread has panicked, as only moves happen under the lock.
    fn papers(&self) -> MutexGuard<'_, Papers<Question, Answer>> {
        self.papers.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for a question; `None` if there will be no more.
    fn next(&self) -> Option<Question> {
        let idle = |papers: &mut Papers<Question, Answer>| papers.question.is_none() && !papers.closed;
        let waited = self.asked.wait_while(self.papers(), idle);
        let mut papers = waited.unwrap_or_else(PoisonError::into_inner);
        if papers.closed { None } else { papers.question.take() }
    }

    /// Gives an answer, replacing one that nobody has taken.
    pub(super) fn give(&self, answer: Answer) {
        let before = self.papers().answer.replace(answer);
        // Not under the lock, since freeing a picture takes a while.
        drop(before);
    }

    /// Returns whether there is a newer question, or nobody is waiting for an answer any more.
    pub(super) fn is_overtaken(&self) -> bool {
        let papers = self.papers();
        papers.question.is_some() || papers.closed
    }
}

impl<Question: Send + 'static, Answer: Send + 'static> Background<Question, Answer> {
    /// Starts the thread, which gives its answers to the desk. Fails if the system has no thread left.
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

    /// Asks a question, replacing the one before if that has not been started.
    pub(super) fn ask(&self, question: Question) {
        let before = self.desk.papers().question.replace(question);
        self.desk.asked.notify_one();
        // Not under the lock, since freeing a scene takes a while.
        drop(before);
    }

    /// Takes the latest answer, if it has not been taken.
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

    /// A thread that reports each question it starts on, and does not finish it until told to.
    fn held_up() -> (Background<u32, u32>, Receiver<u32>, Sender<()>) {
        let (begins, begun) = channel();
        let (go_on, gone_on) = channel::<()>();
        let work = move |question, desk: &Desk<u32, u32>| {
            begins.send(question).expect("the test listens");
            // It also goes on when the test is over.
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
        // Busy, with another question waiting that has not been started.
        let (background, begun, go_on) = held_up();
        background.ask(1);
        assert_eq!(begun.recv_timeout(LONG), Ok(1));
        background.ask(2);
        drop(background);
        go_on.send(()).expect("it works");
        assert!(begun.recv_timeout(LONG).is_err());
    }
}
