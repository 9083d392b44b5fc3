use std::collections::BTreeSet;

use super::*;

/// Method, path, operation.
fn operations(document: &Value) -> Vec<(&str, &str, &Value)> {
    let mut operations = Vec::new();
    for (path, methods) in document["paths"].as_object().unwrap() {
        for (method, operation) in methods.as_object().unwrap() {
            operations.push((method.as_str(), path.as_str(), operation));
        }
    }
    operations
}

#[test]
fn every_route_is_described_to_its_end() {
    let document = document();
    let operations = operations(&document);
    assert!(operations.len() > 40, "{}", operations.len());
    let mut ids = BTreeSet::new();
    for (method, path, operation) in operations {
        let at = format!("{method} {path}: {operation}");
        assert!(ids.insert(operation["operationId"].as_str().unwrap()), "{at}");
        assert!(operation["summary"].as_str().is_some_and(|words| words.ends_with('.')), "{at}");
        assert!(operation["x-cipdeck-need"].is_string(), "{at}");
        let is_open = operation["x-cipdeck-need"] == "anyone";
        assert_eq!(operation["security"].as_array().unwrap().is_empty(), is_open, "{at}");
        let responses = operation["responses"].as_object().unwrap();
        assert!(responses.keys().any(|status| status.starts_with(['1', '2', '3'])), "{at}");
        for code in operation["x-cipdeck-problems"].as_array().unwrap() {
            let code = ProblemCode::from(code.as_str().unwrap().to_owned());
            assert!(ProblemCode::ALL.contains(&code), "{at}");
            let schema =
                &responses[&code.status().to_string()]["content"]["application/problem+json"]["schema"];
            assert!(schema["allOf"][1].to_string().contains(code.word()), "{at}");
        }
        for parameter in path.split(['{', '}']).skip(1).step_by(2) {
            let parameters = operation["parameters"].as_array().unwrap();
            assert!(parameters.iter().any(|told| told["name"] == parameter && told["in"] == "path"), "{at}");
        }
    }
}

#[test]
fn what_the_document_refers_to_is_in_it() {
    let document = document();
    let text = document.to_string();
    let references = text.split("\"$ref\":\"#").skip(1).filter_map(|rest| rest.split('"').next());
    for reference in references {
        assert!(document.pointer(reference).is_some(), "{reference}");
    }
}

/// Who enumerates what may be said over the WebSocket finds it here.
#[test]
fn every_message_of_the_web_socket_is_in_the_document() {
    let document = document();
    for (name, kinds) in [
        ("ClientMessage", &["run", "cancel", "in"][..]),
        ("ServerMessage", &["hello", "snapshot", "changes", "access", "answer"]),
        ("LiveClientMessage", &["watch"]),
        ("LiveServerMessage", &["hello", "access", "tree", "variables", "status", "values", "problem"]),
    ] {
        let told = document["components"]["schemas"][name]["oneOf"].as_array().unwrap();
        assert_eq!(told.len(), kinds.len(), "{told:?}");
        for (told, kind) in told.iter().zip(kinds) {
            assert!(told.to_string().contains(&format!("\"{kind}\"")), "{told}");
        }
    }
}

#[test]
fn what_is_asked_of_the_caller_says_how_to_sign_in() {
    let document = document();
    // In any order: each way to sign in, with the schemes that it takes together.
    let security = |path: &str, method: &str| -> BTreeSet<BTreeSet<String>> {
        let ways = document["paths"][path][method]["security"].as_array().unwrap();
        ways.iter().map(|way| way.as_object().unwrap().keys().cloned().collect()).collect()
    };
    let ways = |ways: &[&[&str]]| -> BTreeSet<BTreeSet<String>> {
        ways.iter().map(|way| way.iter().map(|scheme| (*scheme).to_owned()).collect()).collect()
    };
    assert_eq!(security("/api/v1/health", "get"), ways(&[]));
    assert_eq!(security("/api/v1/blocks", "get"), ways(&[&["session"], &["token"], &["view_link"]]));
    assert_eq!(security("/api/v1/blocks", "post"), ways(&[&["session", "csrf"], &["token"]]));
    assert_eq!(security("/api/v1/users", "post"), ways(&[&["session", "csrf"]]));
}

#[test]
fn integers_say_their_range() {
    let document = document();
    let service = &document["components"]["schemas"]["NewAllowedWrite"]["properties"]["service"];
    assert_eq!((&service["minimum"], &service["maximum"]), (&json!(1), &json!(127)));
    let revision = &document["components"]["schemas"]["WriteRequest"]["properties"]["revision"];
    assert_eq!(revision["maximum"], json!(u64::MAX));
}

#[test]
fn a_closed_object_inside_of_another_one_is_part_of_it() {
    let mut schemas = json!({
        "Inner": {"properties": {"a": {}}, "additionalProperties": false},
        "Outer": {"allOf": [{"$ref": "#/components/schemas/Inner"}, {"properties": {"id": {}}}]},
    });
    join_closed(&mut schemas);
    assert_eq!(schemas["Outer"]["allOf"][0], json!({"properties": {"a": {}}}));
    assert_eq!(schemas["Inner"]["additionalProperties"], false);
}
