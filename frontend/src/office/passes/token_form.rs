//! One more API token. Its secret is shown this once.

use cipdeck_shared::api::{NewToken, Role, TokenCreated};
use yew::prelude::*;

use crate::{
    access::role_word,
    office::{
        api, check,
        fetch::use_action,
        i18n::tr,
        kit::{CopyOnce, Entry, choice, problem_note},
        users::role,
    },
};

#[derive(Clone, PartialEq, Properties)]
pub(super) struct TokenFormProps {
    pub(super) on_made: Callback<()>,
}

/// Name, role, targets and days.
#[component]
pub(super) fn TokenForm(props: &TokenFormProps) -> Html {
    let action = use_action();
    let (name, scope) = (use_state(String::new), use_state(String::new));
    let (days, chosen) = (use_state(|| "90".to_owned()), use_state(|| "viewer".to_owned()));
    let (tried, made) = (use_state(|| false), use_state(|| None::<TokenCreated>));
    let name_problem = check::needed(&name);
    let wanted_days = check::number(&days, 1, 366);
    let onsubmit = {
        let (action, on_made, tried, made) =
            (action.clone(), props.on_made.clone(), tried.clone(), made.clone());
        let (name, scope, chosen, is_named) =
            (name.clone(), scope.clone(), chosen.clone(), name_problem.is_none());
        let wanted_days = wanted_days.clone();
        move |event: SubmitEvent| {
            event.prevent_default();
            tried.set(true);
            made.set(None);
            let (Ok(days), true) = (wanted_days.clone(), is_named) else { return };
            let token =
                NewToken { name: name.trim().to_owned(), role: role(&chosen), scope: rules(&scope), days };
            let (on_made, tried, made, name) = (on_made.clone(), tried.clone(), made.clone(), name.clone());
            action.go(api::add_token(token), move |token| {
                made.set(Some(token));
                name.set(String::new());
                tried.set(false);
                on_made.emit(());
            });
        }
    };
    let on_choice = {
        let chosen = chosen.clone();
        Callback::from(move |word: String| chosen.set(word))
    };
    let roles: Vec<_> = [Role::Viewer, Role::Operator, Role::Engineer]
        .map(|role| (AttrValue::from(role.word()), role_word(role)))
        .to_vec();
    html! {
        <section class="panel narrow">
            <h2>{ tr!("tokens.make_title") }</h2>
            <form {onsubmit}>
                { Entry::text("token-name", tr!("users.name"), &name).hint(tr!("tokens.name_hint")).problem(name_problem.filter(|_| *tried)).draw() }
                { choice("token-role", tr!("users.role"), &chosen, &roles, on_choice) }
                { Entry::text("token-scope", tr!("tokens.scope"), &scope).hint(tr!("tokens.scope_hint")).draw() }
                { Entry::text("token-days", tr!("tokens.days"), &days).problem(wanted_days.err()).draw() }
                { problem_note(action.problem().as_ref()) }
                <button type="submit" class="button primary" disabled={action.is_busy()} data-test="make-token">{ tr!("tokens.make") }</button>
            </form>
            if let Some(made) = &*made {
                <div class="made" role="status">
                    <p><b>{ tr!("tokens.made", name = made.token.name) }</b></p>
                    <CopyOnce label={tr!("tokens.secret")} text={made.secret.clone()} test="token-secret" />
                </div>
            }
        </section>
    }
}

/// Rules with semicolons between them: a route has commas.
fn rules(text: &str) -> Vec<String> {
    text.split(';').map(str::trim).filter(|rule| !rule.is_empty()).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_of_a_token_have_semicolons_between_them() {
        assert_eq!(rules(" 10.0.0.1 via 1,0; plc-4 ;"), ["10.0.0.1 via 1,0", "plc-4"]);
        assert_eq!(rules("  "), [""; 0]);
    }
}
