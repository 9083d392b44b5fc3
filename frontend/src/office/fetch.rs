//! What is asked of the relay, and what comes of it.

use std::{future::Future, pin::Pin, rc::Rc};

use cipdeck_shared::api::Problem;
use gloo_net::http::Method;
use serde::de::DeserializeOwned;
use yew::{platform::spawn_local, prelude::*};

use crate::net::rest::{self, Answered};

/// Something of the relay's: as it was when it was asked for last.
#[derive(Debug)]
pub struct Fetched<T> {
    /// The newest answer.
    pub data: Option<Rc<T>>,
    /// Why there is no newer one.
    pub problem: Option<Rc<Problem>>,
    /// Asks again.
    pub reload: Callback<()>,
}

/// GET of a resource; again whenever its address changes. Answers that are not wanted any more are dropped.
#[hook]
pub fn use_fetched<T: DeserializeOwned + 'static>(resource: String) -> Fetched<T> {
    let data = use_state(|| None::<Rc<T>>);
    let problem = use_state(|| None::<Rc<Problem>>);
    let round = use_state(|| 0_u32);
    use_effect_with((resource, *round), {
        let (data, problem) = (data.clone(), problem.clone());
        move |(resource, _)| {
            let wanted = Rc::new(());
            let (still, resource) = (Rc::downgrade(&wanted), resource.clone());
            spawn_local(async move {
                let answer = read(Method::GET, &resource).await;
                if still.upgrade().is_none() {
                    return;
                }
                match answer {
                    Ok(answer) => {
                        data.set(Some(Rc::new(answer)));
                        problem.set(None);
                    }
                    Err(why) => problem.set(Some(Rc::new(why))),
                }
            });
            move || drop(wanted)
        }
    });
    let reload = Callback::from(move |()| round.set(*round + 1));
    Fetched { data: (*data).clone(), problem: (*problem).clone(), reload }
}

async fn read<T: DeserializeOwned>(method: Method, resource: &str) -> Answered<T> {
    rest::parse(&rest::ask(method, resource, None).await?)
}

/// Something that is done once, when somebody asks for it.
#[derive(Clone, Debug)]
pub struct Action {
    busy: UseStateHandle<bool>,
    problem: UseStateHandle<Option<Rc<Problem>>>,
}

impl Action {
    /// Whether it is under way: a second wish is ignored.
    pub fn is_busy(&self) -> bool {
        *self.busy
    }

    /// Why it was not done the last time.
    pub fn problem(&self) -> Option<Rc<Problem>> {
        (*self.problem).clone()
    }

    /// Does it; `done` hears what came of it.
    pub fn go<T: 'static>(
        &self,
        work: impl Future<Output = Answered<T>> + 'static,
        done: impl FnOnce(T) + 'static,
    ) {
        let work = async move {
            let answer = work.await?;
            Ok(Box::new(move || done(answer)) as Done)
        };
        self.run(Box::pin(work));
    }

    /// Once for all kinds of work: each of its own would be 5 kB of the page.
    fn run(&self, work: Pin<Box<dyn Future<Output = Answered<Done>>>>) {
        if *self.busy {
            return;
        }
        self.busy.set(true);
        let action = self.clone();
        spawn_local(async move {
            let answer = work.await;
            action.busy.set(false);
            match answer {
                Ok(done) => {
                    action.problem.set(None);
                    done();
                }
                Err(problem) => action.problem.set(Some(Rc::new(problem))),
            }
        });
    }
}

/// What follows an answer.
type Done = Box<dyn FnOnce()>;

/// An action of a form or a button.
#[hook]
pub fn use_action() -> Action {
    Action { busy: use_state(|| false), problem: use_state(|| None) }
}
